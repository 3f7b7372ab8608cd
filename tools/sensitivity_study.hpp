// SPDX-License-Identifier: BSD-3-Clause
// Height errors of a pair of barometers on a staircase of known steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/calibration/staircase.hpp"
#include "core/samples.hpp"

namespace isobar::tools {

/// Samples of two barometers, stamps on one clock.
struct BarometerPair {
  std::string name;
  std::vector<PressureSample> moved;
  std::vector<PressureSample> standing;
};

struct StudyOptions {
  double step_m = 0.03;
  double air_temperature_k = 293.15;
  double settle_s = 1.0;        ///< left out before and after each step
  std::optional<double> lag_s;  ///< of the low-pass; default: a tenth of the shortest level, at most 3 s
};

/// Times are seconds since the first sample of the moved barometer.
struct SensorStudy {
  std::string name;
  HeightTrack raw;        ///< without low-pass
  HeightTrack filtered;   ///< after equal low-passes on both pressures, delay subtracted
  double sigma_pa = 0.0;  ///< white noise of the moved barometer's samples
  double lag_s = 0.0;
  double output_sigma_pa = 0.0;  ///< white noise of the moved barometer after the low-pass
  std::vector<Plateau> plateaus;
  StaircaseErrors raw_errors;
  StaircaseErrors filtered_errors;
};

/// Heights without low-pass, in which steps are searched.
HeightTrack raw_track(const BarometerPair& pair, double air_temperature_k);

/// Errors on the levels between steps at known times, or on given levels.
SensorStudy study_pair(const BarometerPair& pair, const std::vector<double>& step_times_s,
                       const StudyOptions& options);
SensorStudy study_pair(const BarometerPair& pair, std::vector<Plateau> plateaus, const StudyOptions& options);

}  // namespace isobar::tools
