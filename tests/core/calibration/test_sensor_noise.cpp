// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/calibration/sensor_noise.hpp"

namespace isobar::test::test_sensor_noise {

TEST_CASE("the noise of a sensor carried up the stairs is taken from its still period") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.35);
  std::vector<double> times;
  std::vector<double> pressures;
  for (int i = 0; i < 200 * 32; ++i) {
    times.push_back(i / 32.0);
    // 3 m up between 20 and 40 s.
    const double climbed_m = 3.0 * std::fmin(1.0, std::fmax(0.0, (times.back() - 20.0) / 20.0));
    pressures.push_back(101'000.0 - 12.0 * climbed_m + normal(random));
  }
  const SensorNoise noise = study_noise(times, pressures);
  CHECK(times[noise.still.begin] >= 40.0);
  CHECK(times[noise.still.begin] <= 45.0);
  CHECK(noise.interval_s == doctest::Approx(1.0 / 32.0));
  // With 5000 samples sigma is accurate to 2 % from the median of differences, to 1 % from the Allan
  // deviation.
  CHECK(noise.sigma_pa == doctest::Approx(0.35).epsilon(0.06).scale(0.0));
  CHECK(noise.allan_sigma_pa() == doctest::Approx(0.35).epsilon(0.04).scale(0.0));
  CHECK(noise.parts.walk < 0.02);
  // The whole series, motion included, is not white noise.
  CHECK(study_still_noise(times, pressures).parts.walk + study_still_noise(times, pressures).parts.ramp >
        0.5);
}

TEST_CASE("a sensor that is never still gives an empty result") {
  std::vector<double> times;
  std::vector<double> pressures;
  for (int i = 0; i < 1000; ++i) {
    times.push_back(0.1 * i);
    pressures.push_back(101'000.0 - 0.5 * i);
  }
  CHECK(study_noise(times, pressures).still.count() == 0);
  CHECK(study_noise({}, {}).still.count() == 0);
}

}  // namespace isobar::test::test_sensor_noise
