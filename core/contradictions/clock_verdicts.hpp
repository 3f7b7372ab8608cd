// SPDX-License-Identifier: BSD-3-Clause
// Clocks of two sensors: streams without a common time, and turns that one of them felt earlier or later.
#pragma once

#include <array>

#include "core/contradictions/finding.hpp"
#include "core/contradictions/motion_series.hpp"
#include "core/contradictions/stream_times.hpp"

namespace isobar {

/// By CheckedSensor.
using AllStreamTimes = std::array<StreamTimes, kCheckedSensors>;

/// Adds each of the robot's own sensors that shares no time with the lidar; or the lidar, where all others agree on another
/// time. The offset is the difference of the starts.
void add_missing_overlaps(const AllStreamTimes& times, Findings& findings);

/// Turns of the three sensors that feel one.
struct TurnStreams {
  const MotionSeries& gyro;
  const MotionSeries& wheels;
  const MotionSeries& scans;
};

/// Adds clocks that are apart by 0.4 s or more. At the lag the turns correlate by 0.6 or more, and no other lag comes near
/// (a lap that repeats itself has several); without a lag by half of that at most, or, where the best correlation is
/// 0.9 or more, with a share missing to 1 that is three times as large. At least 1.5 rad of turns.
/// @param times by CheckedSensor; a search begins where the streams begin, too
void add_clock_findings(const TurnStreams& turns, const AllStreamTimes& times, Findings& findings);

}  // namespace isobar
