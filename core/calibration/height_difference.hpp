// SPDX-License-Identifier: BSD-3-Clause
// Height of one barometer above another from their logs, raw or low-passed. Offline counterpart of
// DifferentialAltimeter.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/calibration/filter_design.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Heights over time.
struct HeightSeries {
  std::vector<std::int64_t> stamps_ns;  ///< of each height, corrected for the filters' delay
  std::vector<double> heights_m;        ///< moved above standing; includes the sensors' offset
};

/// One sensor's log after PressureFilter. Stamps are those of the samples minus the filter's delay.
struct FilteredPressure {
  std::vector<std::int64_t> stamps_ns;
  std::vector<double> pressures_pa;
  FilterDesign design;      ///< steady state; a gain of 1 if unfiltered
  double sigma_pa = 0.0;    ///< white noise of a sample, estimated from the log
  double interval_s = 0.0;  ///< mean time between samples
};

/// Filters a log with lag `lag_s` [s]; 0: unfiltered. At least two samples, stamps ascending. For a station
/// with one row a minute see weather_smoother.hpp.
FilteredPressure filter_log(std::span<const PressureSample> log, double lag_s);

/// Hypsometric equation dz = (R T / g) ln(standing / moved) at every sample of `moved`; the standing pressure
/// is interpolated linearly and held beyond its ends. With equal lags, weather and drafts common to both
/// sensors cancel at any frequency.
HeightSeries height_difference(const FilteredPressure& moved, const FilteredPressure& standing,
                               double air_temperature_k);

}  // namespace isobar
