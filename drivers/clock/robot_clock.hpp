// SPDX-License-Identifier: BSD-3-Clause
// Clock of a live run. Core never reads it: its stages get time stamps with the data.
#pragma once

#include <cstdint>

namespace isobar {

/// CLOCK_MONOTONIC [ns]: the same in all processes of this boot, never set.
[[nodiscard]] std::int64_t monotonic_ns() noexcept;

/// The robot clock of this process: CLOCK_MONOTONIC plus the offset to the wall clock at the process's first
/// reading. Its readings look like Unix time but never jump when the wall clock is set. Another process reads
/// isobard's robot clock as monotonic_ns() + isobard's offset_ns(). Any thread.
class RobotClock {
 public:
  [[nodiscard]] static std::int64_t now_ns() noexcept;
  /// Robot clock minus CLOCK_MONOTONIC [ns], constant for the life of the process.
  [[nodiscard]] static std::int64_t offset_ns() noexcept;
  /// Converts a wall-clock reading to the robot clock.
  /// @param realtime_ns CLOCK_REALTIME within the last second; any other value (the wall clock was just set)
  ///                    converts to now_ns()
  [[nodiscard]] static std::int64_t from_realtime_ns(std::int64_t realtime_ns) noexcept;
};

}  // namespace isobar
