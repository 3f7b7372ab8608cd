// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// Pauses between reads of the lidar's socket, like interrupt moderation of a network card. To wake for each of 750
/// packets a second costs four times as much as decoding them, and the packets of the middle of a scan are not urgent:
/// they are read several at a time, those near the expected end of the scan (last end + last period) one by one. The
/// kernel stamps packets on arrival, so their times do not change. One thread.
class PacketPacing {
 public:
  /// Pause between two reads: six or seven packets of a VLP-16; the kernel buffers 90.
  static constexpr std::int64_t kPauseNs = 8'000'000;
  /// No pause starts later than this before the expected end: the motor holds its speed to a few percent, and a pause
  /// must not reach the end.
  static constexpr std::int64_t kMarginNs = kPauseNs + 4'000'000;
  /// Longest period of a rotating lidar: 4 Hz. A longer gap between scans gives no period.
  static constexpr std::int64_t kLongestScanNs = 250'000'000;

  /// Records the end of a scan.
  void scan_ended(std::int64_t end_stamp_ns) noexcept {
    const std::int64_t period_ns = end_stamp_ns - last_end_ns_;
    const bool turns = last_end_ns_ != 0 && period_ns > 0 && period_ns <= kLongestScanNs;
    expected_end_ns_ = turns ? end_stamp_ns + period_ns : 0;
    last_end_ns_ = end_stamp_ns;
  }

  /// Pause before the next read [ns]; 0: none.
  [[nodiscard]] std::int64_t pause_ns(std::int64_t now_ns) const noexcept {
    return expected_end_ns_ - now_ns >= kMarginNs ? kPauseNs : 0;
  }

 private:
  std::int64_t last_end_ns_ = 0;
  std::int64_t expected_end_ns_ = 0;
};

}  // namespace isobar
