// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/pressure_filter.hpp"

namespace isobar::test::test_noise_and_filter {

TEST_CASE("white noise is measured on top of a constant rate of change") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.35);
  NoiseEstimator estimator({1.0, 0.01, 10.0, 400.0});
  for (int i = 0; i < 4000; ++i) estimator.add(101'000.0 - 0.5 * i + normal(random));
  // Relative standard deviation of the estimate: about sqrt(35/36/400), 5 %; tolerance: three times that.
  CHECK(estimator.sigma() == doctest::Approx(0.35).epsilon(0.15).scale(0.0));
}

TEST_CASE("a single spike does not count as noise, lasting noise does") {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 0.3);
  NoiseEstimator estimator({0.3, 0.01, 1000.0, 200.0});
  for (int i = 0; i < 500; ++i) estimator.add(normal(random));
  estimator.add(500.0);
  for (int i = 0; i < 3; ++i) estimator.add(normal(random));
  CHECK(estimator.sigma() < 0.45);
  for (int i = 0; i < 3000; ++i) estimator.add(10.0 * normal(random));
  CHECK(estimator.sigma() == doctest::Approx(3.0).epsilon(0.2));
}

TEST_CASE("the estimate stays within its bounds, and differences across a gap are ignored") {
  NoiseEstimator still({1.0, 0.1, 2.0, 50.0});
  for (int i = 0; i < 1000; ++i) still.add(7.0);
  CHECK(still.sigma() == 0.1);
  for (int i = 0; i < 100; ++i) {
    still.restart();
    still.add(1e6 * i);
  }
  CHECK(still.sigma() == 0.1);
}

TEST_CASE("the pressure filter has the steady-state variance of its Riccati equation") {
  const double walk = 0.06;
  const double noise = 0.35 * 0.35;
  const double dt = 1.0 / 32.0;
  PressureFilter filter(walk);
  for (int i = 0; i < 2000; ++i) filter.add(1e5, dt, noise);
  // P- = P + q; P = P- R / (P- + R)  =>  P-^2 = q (P- + R).
  const double q = walk * walk * dt;
  const double before = 0.5 * (q + std::sqrt(q * q + 4.0 * q * noise));
  CHECK(filter.variance_pa2() == doctest::Approx(before * noise / (before + noise)).epsilon(1e-9));
}

TEST_CASE("the pressure filter reduces white noise as its variance predicts, and follows a step") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 0.35);
  PressureFilter filter(0.02);
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < 20'000; ++i) {
    filter.add(1e5 + normal(random), 1.0 / 32.0, 0.35 * 0.35);
    if (i < 2000) continue;
    sum += (filter.pressure_pa() - 1e5) * (filter.pressure_pa() - 1e5);
    ++count;
  }
  // The true pressure is constant: half of P, since in steady state walk and noise contribute equally to P.
  CHECK(sum / count == doctest::Approx(0.5 * filter.variance_pa2()).epsilon(0.25));
  // Time constant sqrt(R dt / q) = 3.1 s: four of them reach 98 % of a step.
  for (int i = 0; i < 400; ++i) filter.add(1e5 + 10.0, 1.0 / 32.0, 0.35 * 0.35);
  CHECK(filter.pressure_pa() > 1e5 + 9.7);
}

}  // namespace isobar::test::test_noise_and_filter
