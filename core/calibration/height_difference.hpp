// SPDX-License-Identifier: BSD-3-Clause
// Heights of one barometer above another from their logs, raw and through equal low-passes. For work after
// the fact; the pipeline's stream is DifferentialAltimeter.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/calibration/filter_design.hpp"
#include "core/samples.hpp"

namespace isobar {

struct HeightSeries {
  std::vector<std::int64_t> stamps_ns;  ///< when each height was, the filters' delay taken off
  std::vector<double> heights_m;        ///< moved above standing; the sensors' offset is in it
};

/// One sensor's log through PressureFilter. Each output has the stamp of its own time: that of the sample
/// less the filter's delay.
struct FilteredPressure {
  std::vector<std::int64_t> stamps_ns;
  std::vector<double> pressures_pa;
  FilterDesign design;      ///< in steady state; a gain of 1 where nothing was to be filtered
  double sigma_pa = 0.0;    ///< white noise of a sample, as it was measured in the log itself
  double interval_s = 0.0;  ///< mean time between samples
};

/// `lag_s` 0: the samples as they are. Stamps must ascend, at least two samples. For a base of one row a
/// minute see weather_smoother.hpp.
FilteredPressure filter_log(std::span<const PressureSample> log, double lag_s);

/// dz = (R T / g) ln(standing / moved) at every sample of `moved`; the standing pressure is interpolated
/// between its neighbours and held before the first and after the last. With equal lags weather and drafts
/// that reach both sensors cancel, whatever their speed.
HeightSeries height_difference(const FilteredPressure& moved, const FilteredPressure& standing,
                               double air_temperature_k);

}  // namespace isobar
