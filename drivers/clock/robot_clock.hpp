// SPDX-License-Identifier: BSD-3-Clause
// Clocks of a live run. Core never reads them: its stages get time stamps with the data.
#pragma once

#include <cstdint>

#include "core/time/system_clock_watch.hpp"

namespace isobar {

/// CLOCK_MONOTONIC [ns]: the same in all processes of this boot, never set.
[[nodiscard]] std::int64_t monotonic_ns() noexcept;

/// Reads both clocks as close together as the scheduler allows, about 50 ns.
[[nodiscard]] ClockPair read_clocks() noexcept;

/// Source of clock readings; tests inject their own.
using ClockSource = ClockPair (*)() noexcept;

/// The robot clock of this process: CLOCK_MONOTONIC plus the offset to the system clock at the process's first
/// reading. Its readings look like Unix time but never jump when the system clock is set: SystemClockWatch
/// follows that. Another process reads isobard's robot clock as monotonic_ns() + isobard's offset_ns(). Any
/// thread.
class RobotClock {
 public:
  [[nodiscard]] static std::int64_t now_ns() noexcept;
  /// Robot clock minus CLOCK_MONOTONIC [ns], constant for the life of the process.
  [[nodiscard]] static std::int64_t offset_ns() noexcept;
};

}  // namespace isobar
