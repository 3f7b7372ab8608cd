// SPDX-License-Identifier: BSD-3-Clause
// What one pair of barometers makes of a staircase of known steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/calibration/staircase.hpp"
#include "core/samples.hpp"

namespace isobar::tools {

/// A pair's samples; stamps of both on one clock.
struct BarometerPair {
  std::string name;
  std::vector<PressureSample> moved;
  std::vector<PressureSample> standing;
};

struct StudyOptions {
  double step_m = 0.03;
  double air_temperature_k = 293.15;
  double settle_s = 1.0;        ///< on both sides of a step that do not count
  std::optional<double> lag_s;  ///< of the low-pass; else a tenth of the shortest level, at most 3 s
};

/// Times are seconds since the first sample of the moved barometer.
struct SensorStudy {
  std::string name;
  HeightTrack raw;        ///< from sample to sample
  HeightTrack filtered;   ///< both pressures through equal low-passes, the delay taken off
  double sigma_pa = 0.0;  ///< white noise of the moved barometer's samples
  double lag_s = 0.0;
  double output_sigma_pa = 0.0;  ///< white noise of the moved barometer after the low-pass
  std::vector<Plateau> plateaus;
  StaircaseErrors raw_errors;
  StaircaseErrors filtered_errors;
};

/// Height from sample to sample alone: what steps are looked for in.
HeightTrack raw_track(const BarometerPair& pair, double air_temperature_k);

/// Levels between steps at known times, or levels that are known altogether.
SensorStudy study_pair(const BarometerPair& pair, const std::vector<double>& step_times_s,
                       const StudyOptions& options);
SensorStudy study_pair(const BarometerPair& pair, std::vector<Plateau> plateaus, const StudyOptions& options);

}  // namespace isobar::tools
