// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// Pauses between reads of the lidar's socket, like interrupt moderation of a network card: waking up for
/// each of 750 packets a second costs four times as much as decoding them. Packets of the middle of a scan
/// are read several at a time, those near its expected end (last end + last period) one by one. The kernel
/// stamps packets on arrival, so the pauses do not change their times. One thread.
class PacketPacing {
 public:
  /// Pause between two reads: six or seven packets of a VLP-16; the kernel buffers 90.
  static constexpr std::int64_t kPauseNs = 8'000'000;
  /// Shortest time from the start of a pause to the expected end of the scan: the pause itself, and 4 ms
  /// because the motor holds its speed only to a few percent.
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
