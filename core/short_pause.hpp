// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar {

/// Longest pause between two processes over which a robot may have kept its motion [s]; after a longer one it is
/// expected where it was.
inline constexpr double kLongestShortPauseS = 10.0;

/// True for a pause over which the robot may have kept its motion. Not for one of 0 or less: the clock was set.
[[nodiscard]] inline bool is_short_pause(double pause_s) {
  return pause_s > 0.0 && pause_s < kLongestShortPauseS;
}

}  // namespace isobar
