// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// When the packets of a lidar are fetched. Nobody needs those of the middle of a scan at once: to wake for
/// each of 750 a second costs four times what decoding them does. So they are fetched a few at a time, as
/// network cards moderate their interrupts, and one by one near the end of the scan, which is where the last
/// one ended plus its period. The kernel stamps packets when they come, so no time is lost but that of the
/// processor. One thread.
class PacketPacing {
 public:
  /// Between two looks at the socket: six or seven packets of a VLP-16, of the 90 that the kernel keeps.
  static constexpr std::int64_t kPauseNs = 8'000'000;
  /// From so long before the expected end on every packet is fetched at once: the motor holds its speed to a
  /// few percent, and a pause must not reach the end.
  static constexpr std::int64_t kMarginNs = kPauseNs + 4'000'000;
  /// A scan that lasts longer is none of a lidar that turns.
  static constexpr std::int64_t kLongestScanNs = 250'000'000;

  /// A scan is complete that ended at `end_stamp_ns`.
  void scan_ended(std::int64_t end_stamp_ns) noexcept {
    const std::int64_t period_ns = end_stamp_ns - last_end_ns_;
    const bool turns = last_end_ns_ != 0 && period_ns > 0 && period_ns <= kLongestScanNs;
    expected_end_ns_ = turns ? end_stamp_ns + period_ns : 0;
    last_end_ns_ = end_stamp_ns;
  }

  /// How long to leave the socket alone now; 0: not at all.
  [[nodiscard]] std::int64_t pause_ns(std::int64_t now_ns) const noexcept {
    return expected_end_ns_ - now_ns >= kMarginNs ? kPauseNs : 0;
  }

 private:
  std::int64_t last_end_ns_ = 0;
  std::int64_t expected_end_ns_ = 0;
};

}  // namespace isobar
