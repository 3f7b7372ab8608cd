// SPDX-License-Identifier: BSD-3-Clause
// Two sensors' motions against each other, over windows of a second.
#pragma once

#include <cstdint>
#include <optional>

#include "core/contradictions/motion_series.hpp"

namespace isobar {

/// Turn of a sensor against a reference.
struct TurnRatio {
  double ratio = 0.0;        ///< of the sensor's turn to the reference's; with its sign
  double correlation = 0.0;  ///< of the windows' turns, -1 … 1
  double turned_rad = 0.0;   ///< sum of the reference's turns without sign
  int windows = 0;
};

/// Windows in which the reference turns by 0.04 rad or more. The ratio is that of the rms turns: it does not need to know
/// which of both errs.
TurnRatio compare_turns(const MotionSeries& sensor, const MotionSeries& reference);

/// Way of the wheels against that of the scans, where the robot goes nearly straight.
struct WayRatio {
  double ratio = 0.0;        ///< wheels over scans
  double angle_rad = 0.0;    ///< direction of the scans' way against the wheels', counter-clockwise
  double correlation = 0.0;  ///< 0 … 1: how constant ratio and angle are
  double way_m = 0.0;        ///< by the scans
  int windows = 0;
};
WayRatio compare_ways(const MotionSeries& wheels, const MotionSeries& scans);

/// Changes of the wheels' speed against the accelerometer's, along x and y of base_link: correlation -1 … 1; nothing
/// where the robot hardly brakes or accelerates. A slope does not count: only changes against the mean of ten seconds do.
std::optional<double> compare_accelerations(const MotionSeries& accelerometer, const MotionSeries& wheels);

/// Lag of one sensor's turns behind another's.
struct TurnLag {
  std::int64_t lag_cells = 0;  ///< clock of the sensor minus that of the reference, in cells of 0.1 s
  double correlation = 0.0;    ///< at that lag
  double at_zero = 0.0;        ///< the best without a lag, within 0.3 s
  double second = 0.0;         ///< the best outside of its peak, which reaches down to the half
  double turned_rad = 0.0;     ///< the smaller of both sensors' turns
};
/// Searches a minute either way around `centre_cells`. 12 ms for twenty minutes.
TurnLag find_turn_lag(const MotionSeries& sensor, const MotionSeries& reference, std::int64_t centre_cells);

}  // namespace isobar
