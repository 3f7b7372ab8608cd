// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// Decides when a pose comes from the prior because the lidar is silent: first after
/// 250 ms, which is 2.5 revolutions at 10 Hz, so that no ordinary scan is overtaken;
/// then every 100 ms, at the rate of scans. Also keeps poses in order.
class SilenceBridge {
 public:
  static constexpr std::int64_t kSilenceNs = 250'000'000;
  static constexpr std::int64_t kIntervalNs = 100'000'000;

  /// Records a pose that was emitted.
  void posed(std::int64_t stamp_ns, bool from_scan) {
    newest_pose_ns_ = stamp_ns;
    bridging_ = !from_scan;
    started_ = true;
  }
  /// True when a pose without a scan is due at `now_ns`.
  [[nodiscard]] bool due(std::int64_t now_ns) const {
    return !started_ || now_ns - newest_pose_ns_ >= (bridging_ ? kIntervalNs : kSilenceNs);
  }
  /// True when a pose with this stamp is newer than all before.
  [[nodiscard]] bool in_order(std::int64_t stamp_ns) const { return !started_ || stamp_ns > newest_pose_ns_; }

 private:
  std::int64_t newest_pose_ns_ = 0;
  bool bridging_ = false;
  bool started_ = false;
};

}  // namespace isobar
