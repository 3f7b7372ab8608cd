// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// When the lidar is silent, poses come from the prior. The first one after two and a half revolutions at
/// 10 Hz, so that an ordinary scan is never overtaken; then at the rate of scans.
class SilenceBridge {
 public:
  static constexpr std::int64_t kSilenceNs = 250'000'000;
  static constexpr std::int64_t kIntervalNs = 100'000'000;

  /// A pose went out at `stamp_ns`, from a scan or not.
  void posed(std::int64_t stamp_ns, bool from_scan) {
    newest_pose_ns_ = stamp_ns;
    bridging_ = !from_scan;
    started_ = true;
  }
  /// True where a pose without a scan is due at `now_ns`.
  [[nodiscard]] bool due(std::int64_t now_ns) const {
    return !started_ || now_ns - newest_pose_ns_ >= (bridging_ ? kIntervalNs : kSilenceNs);
  }
  /// True where a pose of this time keeps the order.
  [[nodiscard]] bool in_order(std::int64_t stamp_ns) const { return !started_ || stamp_ns > newest_pose_ns_; }

 private:
  std::int64_t newest_pose_ns_ = 0;
  bool bridging_ = false;
  bool started_ = false;
};

}  // namespace isobar
