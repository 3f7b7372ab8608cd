// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/time/system_clock_watch.hpp"

namespace isobar::pps {

struct PulseFigures {
  std::uint64_t pulses = 0;
  std::uint64_t missing = 0;   ///< seconds between two pulses without one
  std::uint64_t extra = 0;     ///< edges that are no whole second after the last pulse
  std::int64_t newest_ns = 0;  ///< CLOCK_MONOTONIC; 0: none yet
  std::int64_t offset_ns = 0;  ///< system clock at the newest pulse minus its nearest whole second
  double jitter_ns = 0.0;      ///< standard deviation of the time between pulses, over about 16
};

/// Pulses a second, by the kernel's stamps of their edges. No I/O, no clock; nothing is allocated.
///
/// The stamps are of CLOCK_MONOTONIC, whose rate is that of the system clock, at most 500 ppm off.
class PulseWatch {
 public:
  /// Largest difference of the time between two pulses from whole seconds [ns for each second].
  static constexpr std::int64_t kToleranceNs = 10'000'000;
  /// Edges in a row that fit no second, after which the last one counts as a pulse: the pulse before was none.
  static constexpr int kMostAstray = 3;

  /// @param edge_ns CLOCK_MONOTONIC, not before the last edge
  /// @param clocks read soon after the edge: at 25 ms and 500 ppm the offset errs by 12 us
  void add(std::int64_t edge_ns, const ClockPair& clocks) noexcept;
  [[nodiscard]] const PulseFigures& figures() const noexcept { return figures_; }
  /// The line was closed: what follows is no missing pulse.
  void interrupt() noexcept { figures_.newest_ns = 0; }

 private:
  void take(std::int64_t edge_ns, const ClockPair& clocks) noexcept;

  PulseFigures figures_;
  int astray_ = 0;
  int periods_ = 0;       ///< in the means, at most kMemory
  double mean_ns_ = 0.0;  ///< of the periods, beyond a second
  double variance_ns2_ = 0.0;
};

}  // namespace isobar::pps
