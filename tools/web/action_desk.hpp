// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/pose_hint.hpp"

namespace isobar::web {

/// What a viewer with the token has asked for.
struct Order {
  enum class Kind : std::uint8_t { kSaveBlackBox, kPoseHint };
  Kind kind = Kind::kSaveBlackBox;
  ipc::PoseHint hint;  ///< of kPoseHint
};

/// Hands orders from the threads of viewers to the one that speaks with isobard. One order waits at a time.
class ActionDesk {
 public:
  /// @return false while another order waits: none is queued without limit
  bool offer(const Order& order) {
    const std::lock_guard lock(mutex_);
    if (order_) return false;
    order_ = order;
    return true;
  }
  /// The waiting order, once.
  std::optional<Order> take() {
    const std::lock_guard lock(mutex_);
    std::optional<Order> taken;
    taken.swap(order_);
    return taken;
  }

 private:
  std::mutex mutex_;
  std::optional<Order> order_;
};

/// Parses the body of /api/initial-pose: {"x_m": …, "y_m": …, "yaw_deg": …}.
/// @param[out] reason why there is no hint
[[nodiscard]] std::optional<ipc::PoseHint> parse_hint(std::string_view body, std::string& reason);

}  // namespace isobar::web
