// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/airflow.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

namespace isobar::test::test_airflow {

namespace {

constexpr double kCoefficient = 0.017;  // a real robot's

struct Outcome {
  AirflowEstimator estimator;
  double rms_without_m = 0.0;  ///< of the second half, mean removed
  double rms_with_m = 0.0;
};

/// Drives for `duration_s` with heights at 8 Hz of 2 cm noise, 3 cm of turbulence over 3 s, and a drifting bias.
Outcome drive(const std::function<double(double)>& speed, unsigned seed, double duration_s = 240.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Outcome outcome;
  double turbulence_m = 0.0;
  double sums[4] = {};  // NOLINT(modernize-avoid-c-arrays)
  int count = 0;
  const double keep = std::exp(-0.125 / 3.0);
  for (double t = 0.0; t < duration_s; t += 0.125) {
    turbulence_m = keep * turbulence_m + 0.03 * std::sqrt(1.0 - keep * keep) * normal(random);
    const double v = speed(t);
    const double bias_m = 0.1 + 0.0002 * t;
    const double noisy_m = bias_m + turbulence_m + 0.02 * normal(random) + kCoefficient * v * v;
    if (t > 0.5 * duration_s) {
      const double without = kCoefficient * v * v;
      const double with = without - outcome.estimator.correction_m(v);
      sums[0] += without;
      sums[1] += without * without;
      sums[2] += with;
      sums[3] += with * with;
      ++count;
    }
    outcome.estimator.add(t == 0.0 ? 0.0 : 0.125, v, noisy_m, 4e-4);
  }
  outcome.rms_without_m = std::sqrt(sums[1] / count - sums[0] * sums[0] / count / count);
  outcome.rms_with_m = std::sqrt(std::max(0.0, sums[3] / count - sums[2] * sums[2] / count / count));
  return outcome;
}

double stop_and_go(double t) { return std::fmod(t, 30.0) < 18.0 ? 3.0 : 0.3; }

}  // namespace

TEST_CASE(
    "starts and stops at 3 m/s show the airflow's coefficient within its sigma, and its error shrinks to a "
    "third") {
  double normalised = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Outcome outcome = drive(stop_and_go, seed);
    const double error = outcome.estimator.coefficient() - kCoefficient;
    CHECK(outcome.estimator.sigma() < 0.0025);
    CHECK(std::abs(error) < 3.0 * outcome.estimator.sigma());
    normalised += 0.1 * error * error / (outcome.estimator.sigma() * outcome.estimator.sigma());
    CHECK(outcome.rms_with_m < outcome.rms_without_m / 3.0);
  }
  CHECK(normalised < 2.0);
  CHECK(normalised > 0.02);
}

TEST_CASE("at a constant speed nothing is learnt, and at walking speed little") {
  const auto constant = drive([](double) { return 3.0; }, 3);
  // b is known to 20 cm a priori, so k to 0.2 m / 9 (m/s)^2 = 0.022: no better than before.
  CHECK(constant.estimator.sigma() > 0.01);
  const auto slow = drive([](double t) { return std::fmod(t, 30.0) < 18.0 ? 0.6 : 0.0; }, 3);
  CHECK(slow.estimator.sigma() > 0.01);
  // Its correction cannot harm there: k of the a-priori sigma is 7 mm.
  CHECK(std::abs(slow.estimator.correction_m(0.6)) < 0.01);
}

TEST_CASE("the coefficient stays within the stagnation pressure's, and a zone of ventilation is left out") {
  AirflowEstimator estimator;
  for (int i = 0; i < 400; ++i) estimator.add(0.125, i % 80 < 40 ? 0.0 : 1.0, i % 80 < 40 ? 0.0 : 0.15, 1e-4);
  CHECK(estimator.coefficient() <= AirflowEstimator::kLargestCoefficient);
  const double before = estimator.coefficient();
  estimator.add(0.125, 1.0, 20.0, 1e-4);
  estimator.add(0.125, 1.0, std::nan(""), 1e-4);
  CHECK(estimator.coefficient() == before);
  CHECK(estimator.correction_variance_m2(2.0) == doctest::Approx(std::pow(4.0 * estimator.sigma(), 2)));
}

}  // namespace isobar::test::test_airflow
