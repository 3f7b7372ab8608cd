// SPDX-License-Identifier: BSD-3-Clause
// The weather between the few and noisy rows of a station, after the fact.
#pragma once

#include <span>

#include "core/calibration/height_difference.hpp"
#include "core/samples.hpp"

namespace isobar {

struct WeatherModel {
  /// Steady change of the weather, 1 sigma [Pa/s], and how long it lasts [s]: fronts bring 100 Pa an hour,
  /// usual days 30.
  double rate_sigma_pa_s = 0.015;
  double rate_time_s = 3600.0;
  /// What comes on top, as a random walk [Pa/sqrt(s)]: 0.4 Pa in a minute.
  double walk_pa_sqrt_s = 0.05;
  /// Noise of a row [Pa] where there are too few of them to see it: a station samples the wind's dynamic
  /// pressure with its own (3 m/s stagnate at 5 Pa).
  double default_sigma_pa = 3.0;
};

/// Kalman smoother (Rauch, Tung, Striebel 1965) of level and rate of change through the rows: uses the rows
/// after a moment as well as those before, so it neither lags nor has a delay. The noise is measured where
/// there are 30 rows or more. Beyond the first and the last row the weather is carried on at its rate for
/// five minutes. Stamps must ascend, at least one row; linear between the points that come back.
FilteredPressure smooth_weather(std::span<const PressureSample> rows, const WeatherModel& model = {});

}  // namespace isobar
