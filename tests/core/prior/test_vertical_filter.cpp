// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/prior/vertical_filter.hpp"

namespace isobar::test::test_vertical_filter {

using V = VerticalFilter;

TEST_CASE("the covariance is propagated as F P F^T + Q") {
  HeightConfig config;
  V filter(config);
  filter.start(0.0, 0.1);
  for (int i = 0; i < 50; ++i) {
    filter.predict(0.1, 0.005, 1e-4, true);
    if (i % 7 == 0) filter.update_pressure(0.3, 0.02, 1e-3);
    if (i % 5 == 0) filter.update_climb(0.05, 0.6, 1e-3);
  }
  const double dt = 0.005;
  const double keep = std::exp(-dt / config.turbulence_time_s);
  V::Matrix F = V::Matrix::Identity();
  F(V::kZ, V::kVz) = dt;
  F(V::kZ, V::kAccelBias) = -0.5 * dt * dt;
  F(V::kVz, V::kAccelBias) = -dt;
  F(V::kTurbulence, V::kTurbulence) = keep;
  const double keep_rate = std::exp(-dt / V::kWeatherRateTimeS);
  F(V::kWeather, V::kWeatherRate) = dt;
  F(V::kWeatherRate, V::kWeatherRate) = keep_rate;
  V::Matrix Q = V::Matrix::Zero();
  Q(V::kZ, V::kZ) = 1e-4 * dt * dt * dt / 3.0;
  Q(V::kZ, V::kVz) = Q(V::kVz, V::kZ) = 1e-4 * dt * dt / 2.0;
  Q(V::kVz, V::kVz) = 1e-4 * dt;
  Q(V::kAccelBias, V::kAccelBias) = std::pow(config.accel_bias_walk_m_s2_sqrt_s, 2) * dt;
  Q(V::kSlope, V::kSlope) = std::pow(config.slope_walk_rad_sqrt_s, 2) * dt;
  Q(V::kTurbulence, V::kTurbulence) = std::pow(config.turbulence_sigma_m, 2) * (1.0 - keep * keep);
  Q(V::kWeather, V::kWeather) = std::pow(config.weather_walk_m_sqrt_s, 2) * dt;
  Q(V::kWeatherRate, V::kWeatherRate) = std::pow(config.weather_rate_m_s, 2) * (1.0 - keep_rate * keep_rate);
  const V::Matrix expected = F * filter.covariance() * F.transpose() + Q;
  filter.predict(0.0, dt, 1e-4, true);
  CHECK((filter.covariance() - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("the error of every state stays within the filter's own covariance (NEES)") {
  HeightConfig config;
  config.turbulence_sigma_m = 0.03;
  config.offset_learning_s = 1e3;  // longer than the run: offset errors would become height errors
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  const double dt = 0.01;
  const double density = 1e-3;
  double nees = 0.0;
  const int runs = 60;
  for (int run = 0; run < runs; ++run) {
    V filter(config);
    filter.start(0.0, 0.05);
    double z = 1e-3 * normal(random);
    double vz = 0.05 * normal(random);
    double bias = config.accel_bias_sigma_m_s2 * normal(random);
    double slope = config.slope_sigma_rad * normal(random);
    double offset = 10.0 * normal(random);
    double n = config.turbulence_sigma_m * normal(random);
    const double keep = std::exp(-dt / config.turbulence_time_s);
    for (int i = 1; i <= 2000; ++i) {
      const double accel = 0.5 * std::cos(0.01 * i);
      // The truth moves with the exact acceleration; the filter is fed a noisy, biased one.
      z += vz * dt + 0.5 * accel * dt * dt;
      vz += accel * dt;
      bias += config.accel_bias_walk_m_s2_sqrt_s * std::sqrt(dt) * normal(random);
      slope += config.slope_walk_rad_sqrt_s * std::sqrt(dt) * normal(random);
      n = keep * n + config.turbulence_sigma_m * std::sqrt(1.0 - keep * keep) * normal(random);
      filter.predict(accel + bias + std::sqrt(density / dt) * normal(random), dt, density, false);
      if (i % 3 == 0) filter.update_pressure(z + offset + n + 0.04 * normal(random), 0.0, 0.04 * 0.04);
      if (i % 4 == 0) filter.update_climb(vz - slope * 0.6 + 0.02 * normal(random), 0.6, 0.02 * 0.02);
    }
    Eigen::Matrix<double, 6, 1> error;
    error << filter.value(V::kZ) - z, filter.value(V::kVz) - vz, filter.value(V::kAccelBias) - bias,
        filter.value(V::kSlope) - slope, filter.value(V::kOffset) - offset, filter.value(V::kTurbulence) - n;
    const Eigen::Matrix<double, 6, 6> P = filter.covariance().topLeftCorner<6, 6>();
    nees += error.dot(P.ldlt().solve(error));
  }
  // Chi-squared with 360 degrees of freedom: 6 +- 0.45 a run (1 sigma); three of them.
  CHECK(nees / runs > 4.7);
  CHECK(nees / runs < 7.4);
}

TEST_CASE("a ventilation zone entered after the learning time never becomes part of the offset") {
  HeightConfig config;
  V filter(config);
  filter.start(0.0, 0.01);
  const auto drive = [&](double seconds, double pressure_height_m) {
    for (int i = 0; i < static_cast<int>(seconds / 0.02); ++i) {
      filter.predict(0.0, 0.02, 1e-4, false);
      filter.update_pressure(pressure_height_m, 0.0, 1e-3);
      filter.update_climb(0.0, 0.6, 1e-3);
    }
  };
  drive(config.offset_learning_s + 1.0, 5.0);
  CHECK(filter.value(V::kOffset) == doctest::Approx(5.0).epsilon(1e-3));
  CHECK(filter.variance(V::kOffset) == 0.0);
  drive(300.0, 4.85);
  drive(300.0, 5.0);
  // Back at the initial pressure the height returns to 0, to less than one sigma of the turbulence.
  CHECK(std::abs(filter.value(V::kZ)) < 0.02);
}

TEST_CASE("a delayed pressure is compared with the height at its own time") {
  V filter{HeightConfig{}};
  filter.start(0.0, 1e-6);
  for (int i = 0; i < 200; ++i) filter.update_pressure(0.0, 0.0, 1e-4);
  for (int i = 0; i < 200; ++i) filter.predict(0.5, 0.01, 1e-6, false);  // 2 s up at 0.5 m/s^2: 1 m, 1 m/s
  CHECK(std::abs(filter.pressure_innovation(1.0 - 0.1, 0.1, 1e-4).value) < 1e-3);
}

TEST_CASE("weather is folded into the offset, or corrected by a measurement of it") {
  HeightConfig config;
  V filter(config);
  filter.start(0.0, 0.01);
  for (int i = 0; i < 100; ++i) filter.update_pressure(0.0, 0.0, 1e-4);
  for (int i = 0; i < 1000; ++i) filter.predict(0.0, 0.01, 1e-4, true);
  filter.update_pressure(0.4, 0.0, 1e-4);
  V folded = filter;
  const double sum = filter.value(V::kOffset) + filter.value(V::kWeather);
  folded.fold_weather_into_offset();
  CHECK(folded.value(V::kOffset) == doctest::Approx(sum));
  CHECK(folded.variance(V::kWeather) == 0.0);
  // All of the 0.4 m is weather: the part that had been attributed to the height is removed from it.
  V settled = filter;
  REQUIRE(std::abs(filter.value(V::kZ)) > 0.02);
  settled.settle_weather(0.4, 1e-6);
  CHECK(std::abs(settled.value(V::kZ)) < 0.3 * std::abs(filter.value(V::kZ)));
  CHECK(settled.variance(V::kZ) < filter.variance(V::kZ));
}

TEST_CASE("an open step state absorbs a jump; closing it leaves the variance of the offset unchanged") {
  HeightConfig config;
  V filter(config);
  filter.start(0.0, 0.01);
  for (int i = 0; i < 200; ++i) {
    filter.predict(0.0, 0.01, 1e-6, false);
    filter.update_pressure(0.0, 0.0, 1e-4);
  }
  const double before_m = filter.value(V::kZ);
  const double offset_variance_m2 = filter.variance(V::kOffset);
  filter.open_step(100.0);
  filter.update_pressure(7.0, 0.0, 1e-4);
  CHECK(filter.value(V::kStep) == doctest::Approx(7.0).epsilon(1e-2));
  CHECK(std::abs(filter.value(V::kZ) - before_m) < 1e-4);
  CHECK(filter.innovation_without_step(0.0, 0.0, 1e-4).value == doctest::Approx(0.0).epsilon(1e-3));
  filter.close_step();
  CHECK_FALSE(filter.step_open());
  CHECK(std::abs(filter.pressure_innovation(0.0, 0.0, 1e-4).value) < 1e-2);
  CHECK(filter.variance(V::kOffset) == doctest::Approx(offset_variance_m2).epsilon(1e-3));
}

}  // namespace isobar::test::test_vertical_filter
