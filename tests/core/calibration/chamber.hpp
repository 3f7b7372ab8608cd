// SPDX-License-Identifier: BSD-3-Clause
// Simulated sensor and reference in a climate chamber, after the paper's: eight cycles from 50 to 15 degC,
// one to 0, five hours at room temperature, with changing weather.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/calibration/calibration.hpp"

namespace isobar::test {

struct Chamber {
  Compensation hidden;  ///< raw to true pressure
  double noise_pa = 4.0;
  unsigned seed = 1;

  [[nodiscard]] std::vector<CalibrationRecording> record() const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<CalibrationRecording> recordings;
    for (int run = 0; run < 10; ++run) {
      const bool is_static = run == 9;
      const double lowest_c = run == 8 ? 0.0 : 15.0;
      const double hours = is_static ? 5.0 : 2.0;
      CalibrationRecording recording{"run " + std::to_string(run), {}};
      double raw_pa = 98'000.0 + 600.0 * normal(random);
      for (double t = 0.0; t < hours; t += 10.0 / 3600.0) {
        raw_pa += 1.5 * normal(random);  // a random walk of 30 Pa an hour
        const double temperature_c =
            is_static ? 22.0 + 0.3 * std::sin(t) : 50.0 + (lowest_c - 50.0) * t / hours;
        recording.pairs.push_back(
            {hidden(raw_pa, temperature_c) + noise_pa * normal(random), raw_pa, temperature_c});
      }
      recordings.push_back(std::move(recording));
    }
    return recordings;
  }

  /// Systematic error: rms of compensated minus true pressure over 5 … 50 degC and the recorded pressures.
  [[nodiscard]] double systematic_rms_pa(const Compensation& found, const CalibratedRange& range) const {
    double sum = 0.0;
    int count = 0;
    for (double t = 5.0; t <= 50.0; t += 2.5) {
      for (int k = 0; k <= 20; ++k, ++count) {
        const double p = range.lowest_pa + (range.highest_pa - range.lowest_pa) * k / 20.0;
        const double error = compensated_pa(found, range, p, t) - hidden(p, t);
        sum += error * error;
      }
    }
    return std::sqrt(sum / count);
  }
};

}  // namespace isobar::test
