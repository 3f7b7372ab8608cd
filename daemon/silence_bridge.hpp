// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace isobar {

/// Decides when a pose comes from the prior because the lidar is silent: first after 2.5 of the lidar's own
/// intervals, which are learnt, so that no ordinary scan is overtaken, wherever it is still being collected
/// (250 ms at 10 Hz, 2.5 s at 1 Hz); then every 100 ms. Before the first scan poses are due every 100 ms. Also
/// keeps poses in order.
class SilenceBridge {
 public:
  static constexpr std::int64_t kShortestSilenceNs = 250'000'000;
  static constexpr std::int64_t kLongestSilenceNs = 5'000'000'000;
  static constexpr std::int64_t kIntervalNs = 100'000'000;

  /// Records a scan by the time of its end, its pose emitted or not.
  void scanned(std::int64_t end_stamp_ns) {
    if (heard_ && end_stamp_ns > scan_ns_) learn(end_stamp_ns - scan_ns_);
    scan_ns_ = heard_ ? std::max(scan_ns_, end_stamp_ns) : end_stamp_ns;
    heard_ = true;
    bridging_ = false;
  }
  /// Records a pose that was emitted.
  void posed(std::int64_t stamp_ns, bool from_scan) {
    newest_pose_ns_ = stamp_ns;
    bridging_ = !from_scan;
    started_ = true;
  }
  /// True when a pose without a scan is due at `now_ns`.
  [[nodiscard]] bool due(std::int64_t now_ns) const {
    if (!started_) return true;
    if (bridging_) return now_ns - newest_pose_ns_ >= kIntervalNs;
    return now_ns - (heard_ ? scan_ns_ : newest_pose_ns_) >= silence_ns() &&
           now_ns - newest_pose_ns_ >= kIntervalNs;
  }
  /// True when a pose with this stamp is newer than all before.
  [[nodiscard]] bool in_order(std::int64_t stamp_ns) const { return !started_ || stamp_ns > newest_pose_ns_; }

  /// Whether the lidar's interval has been learnt.
  [[nodiscard]] bool known() const { return interval_ns_ > 0; }
  /// Time after the end of the last scan from which the lidar is silent.
  [[nodiscard]] std::int64_t silence_ns() const {
    // Two intervals and a half: a scan may be complete only with the first packet of the next one.
    return std::clamp(interval_ns_ * 5 / 2, kShortestSilenceNs, kLongestSilenceNs);
  }

 private:
  // Fast to a shorter interval, which the lidar has shown to be possible; slowly to a longer one: a lost scan or a
  // pause is not the lidar's pace.
  void learn(std::int64_t step_ns) {
    step_ns = std::min(step_ns, kLongestSilenceNs);
    if (interval_ns_ == 0) {
      interval_ns_ = step_ns;
    } else if (step_ns < interval_ns_) {
      interval_ns_ -= (interval_ns_ - step_ns) / 2;
    } else {
      interval_ns_ += (std::min(step_ns, 2 * interval_ns_) - interval_ns_) / 8;
    }
  }

  std::int64_t newest_pose_ns_ = 0;
  std::int64_t scan_ns_ = 0;      // end of the newest scan
  std::int64_t interval_ns_ = 0;  // between scans; 0: unknown
  bool heard_ = false;
  bool bridging_ = false;
  bool started_ = false;
};

}  // namespace isobar
