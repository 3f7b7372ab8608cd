// SPDX-License-Identifier: BSD-3-Clause
// The page of `isobar noise`.
#pragma once

#include <string>
#include <vector>

#include "core/calibration/filter_design.hpp"
#include "core/calibration/sensor_noise.hpp"

namespace isobar::report {

struct NoiseReport {
  std::string title;
  std::string source;   ///< a sentence: number, rate and period of the samples
  std::string command;  ///< the command line that makes this report
  SensorNoise noise;
  double cm_per_pa = 8.5;             ///< height per pascal at the pressure of the log
  std::vector<FilterDesign> designs;  ///< settings of the low-pass to choose from
  FilterDesign chosen;
  std::vector<double> times_s;  ///< of all samples
  std::vector<double> pressures_pa;
};

std::string render_noise_report(const NoiseReport& report);

}  // namespace isobar::report
