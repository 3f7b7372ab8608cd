// SPDX-License-Identifier: BSD-3-Clause
// Finds how two loggers' clocks differ from the weather that both have measured.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "core/calibration/pressure_series.hpp"

namespace isobar {

struct ShiftSearch {
  double window_s = 6.0 * 3600.0;  ///< shifts up to this are tried, both ways; covers a wrong time zone
  double centre_s = 0.0;           ///< about this shift
};

struct ClockShift {
  double shift_s = 0.0;  ///< reference's time = sensor's time + shift
  double sigma_s =
      0.0;  ///< 1 sigma of it for white noise; slow errors of sensors make it two to three times that
  double correlation = 0.0;  ///< of the changes of pressure at that shift
  /// The best shift that is no part of the same peak: apart from it by a place with half its correlation.
  double next_best_shift_s = std::numeric_limits<double>::quiet_NaN();
  double next_best_correlation = 0.0;
  double scale_s = 0.0;     ///< pressures were averaged over this time before their changes were compared
  std::size_t changes = 0;  ///< how many were
  std::string doubt;        ///< why the shift cannot be believed; empty: it can
};

/// The shift at which changes of the sensor's pressure are most like changes of the reference's. Changes,
/// because a sensor's slow errors (temperature) must not count; over several lengths of time, because weather
/// is slow where sensors are noisy: of those whose peak is clear, the one with the sharpest is taken. All
/// sensor series belong to the same clock.
ClockShift find_clock_shift(std::span<const PressureSeries> sensor, const PressureSeries& reference,
                            const ShiftSearch& search = {});

}  // namespace isobar
