// SPDX-License-Identifier: BSD-3-Clause
// Offline smoother of the weather between the sparse and noisy rows of a station.
#pragma once

#include <span>

#include "core/calibration/height_difference.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Model of the weather and of a station's noise.
struct WeatherModel {
  /// Rate of change, 1 sigma [Pa/s], and its correlation time [s]: fronts bring 100 Pa an hour, usual
  /// days 30.
  double rate_sigma_pa_s = 0.015;
  double rate_time_s = 3600.0;
  /// Additional random walk [Pa/sqrt(s)]: 0.4 Pa in a minute.
  double walk_pa_sqrt_s = 0.05;
  /// Noise of a row [Pa] if there are too few rows to estimate it: a station also samples the dynamic
  /// pressure of the wind (5 Pa at 3 m/s).
  double default_sigma_pa = 3.0;
};

/// Kalman smoother (Rauch, Tung, Striebel 1965) of level and rate: uses rows before and after each time, so
/// it has no lag. The noise is estimated from 30 rows or more. Extrapolates at the final rates for five
/// minutes beyond the first and the last row. At least one row, stamps ascending; interpolate the result
/// linearly.
FilteredPressure smooth_weather(std::span<const PressureSample> rows, const WeatherModel& model = {});

}  // namespace isobar
