// SPDX-License-Identifier: BSD-3-Clause
// Difference of two loggers' clocks from the weather that both measured.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "core/calibration/pressure_series.hpp"

namespace isobar {

/// Range of the search: centre_s ± window_s.
struct ShiftSearch {
  double window_s = 6.0 * 3600.0;  ///< 6 h cover most wrong time zones
  double centre_s = 0.0;
};

/// Result of the search.
struct ClockShift {
  double shift_s = 0.0;  ///< reference's time = sensor's time + shift
  /// Standard deviation of shift_s for white noise; slow sensor errors make it two to three times larger.
  double sigma_s = 0.0;
  double correlation = 0.0;  ///< of the changes of pressure at that shift
  /// Best shift outside the peak, separated from it by a point with half its correlation.
  double next_best_shift_s = std::numeric_limits<double>::quiet_NaN();
  double next_best_correlation = 0.0;
  double scale_s = 0.0;     ///< averaging time of the compared changes
  std::size_t changes = 0;  ///< number of compared changes
  std::string doubt;        ///< reason why the shift is not credible; empty: it is
};

/// Shift that maximises the correlation of the sensor's and the reference's changes of pressure. Changes
/// instead of pressures remove a sensor's slow errors (temperature). Several time scales are tried, since
/// weather is slow and sensors are noisy; of the scales with a credible peak the sharpest wins. All sensor
/// series must share one clock.
ClockShift find_clock_shift(std::span<const PressureSeries> sensor, const PressureSeries& reference,
                            const ShiftSearch& search = {});

}  // namespace isobar
