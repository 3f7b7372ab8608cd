// SPDX-License-Identifier: BSD-3-Clause
// One page about a sensor's noise.
#pragma once

#include <string>
#include <vector>

#include "core/calibration/filter_design.hpp"
#include "core/calibration/sensor_noise.hpp"

namespace isobar::report {

struct NoiseReport {
  std::string title;
  std::string source;   ///< which samples, in words
  std::string command;  ///< that made it
  SensorNoise noise;
  double cm_per_pa = 8.5;             ///< height of a pascal at the place of the recording
  std::vector<FilterDesign> designs;  ///< settings of the low-pass to choose from
  FilterDesign chosen;
  std::vector<double> times_s;  ///< of all samples, for the first picture
  std::vector<double> pressures_pa;
};

std::string render_noise_report(const NoiseReport& report);

}  // namespace isobar::report
