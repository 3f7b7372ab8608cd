// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/calibration/height_difference.hpp"
#include "core/calibration/weather_smoother.hpp"
#include "tests/core/altitude/isothermal_air.hpp"

namespace isobar::test::test_height_difference {

namespace {

constexpr double kAirK = 290.0;
constexpr std::int64_t kStartNs = 1'760'000'000'000'000'000;

/// Log of a pressure given as a function of time, samples `dt_s` apart.
template <typename Pressure>
std::vector<PressureSample> sampled(double from_s, double to_s, double dt_s, double sigma_pa, unsigned seed,
                                    const Pressure& pressure_pa) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PressureSample> samples;
  for (double t = from_s; t < to_s; t += dt_s) {
    PressureSample sample;
    sample.stamp_ns = kStartNs + std::llround(1e9 * t);
    sample.pressure_pa = pressure_pa(t) + sigma_pa * normal(random);
    samples.push_back(sample);
  }
  return samples;
}

double seconds(std::int64_t stamp_ns) { return 1e-9 * static_cast<double>(stamp_ns - kStartNs); }

}  // namespace

TEST_CASE("unfiltered, the difference is the hypsometric height in any common weather") {
  const auto weather = [](double t) { return 101'000.0 + 50.0 * std::sin(0.05 * t); };
  const auto moved = sampled(0.0, 60.0, 1.0 / 32.0, 0.0, 1,
                             [&](double t) { return hypsometric_pressure_pa(weather(t), 0.1 * t, kAirK); });
  const auto standing = sampled(0.011, 60.0, 1.0 / 32.0, 0.0, 2, weather);
  const HeightSeries series = height_difference(filter_log(moved, 0.0), filter_log(standing, 0.0), kAirK);
  REQUIRE(series.heights_m.size() == moved.size());
  for (std::size_t i = 0; i < series.heights_m.size(); ++i) {
    const double t = seconds(series.stamps_ns[i]);
    if (t < 0.1 || t > 59.9) continue;  // beyond the standing sensor's samples
    // Interpolation error over 31 ms of this weather: 50 (0.05)^2 (0.031)^2 / 8 Pa.
    CHECK(series.heights_m[i] == doctest::Approx(0.1 * t).epsilon(1e-5).scale(0.0));
  }
}

TEST_CASE("with equal low-passes common drafts cancel, and a climb has no lag") {
  // A draft of 20 Pa in 4 s: a low-pass on one side only would leave errors of metres.
  const auto draft = [](double t) { return 101'000.0 + 20.0 * std::sin(2.0 * std::numbers::pi * t / 4.0); };
  const auto moved = sampled(0.0, 120.0, 1.0 / 32.0, 0.3, 3,
                             [&](double t) { return hypsometric_pressure_pa(draft(t), 0.25 * t, kAirK); });
  const auto standing = sampled(0.011, 120.0, 1.0 / 32.0, 0.4, 4, draft);
  const double lag_s = 1.0;
  const FilteredPressure slow = filter_log(moved, lag_s);
  CHECK(slow.sigma_pa == doctest::Approx(0.3).epsilon(0.1).scale(0.0));
  CHECK(slow.design.delay_s == doctest::Approx(lag_s));
  const HeightSeries series = height_difference(slow, filter_log(standing, lag_s), kAirK);
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < series.heights_m.size(); ++i) {
    const double t = seconds(series.stamps_ns[i]);
    if (t < 5.0 || t > 118.0) continue;
    squares += std::pow(series.heights_m[i] - 0.25 * t, 2);
    count += 1.0;
  }
  // White noise of 0.5 Pa times sqrt(K / (2 - K)) = 0.12 and 8.4 cm/Pa: 0.53 cm. The draft adds the error of
  // interpolating between the stamps of the two sensors.
  CHECK(std::sqrt(squares / count) < 0.008);
  const HeightSeries raw = height_difference(filter_log(moved, 0.0), filter_log(standing, lag_s), kAirK);
  double largest = 0.0;
  for (std::size_t i = raw.heights_m.size() / 2; i < raw.heights_m.size() - 64; ++i) {
    largest = std::max(largest, std::abs(raw.heights_m[i] - 0.25 * seconds(raw.stamps_ns[i])));
  }
  CHECK(largest > 0.5);
}

TEST_CASE("a base with one row a minute is smoothed without lag, and extrapolated beyond its rows") {
  // 90 Pa an hour, 7.6 m; rows with 3 Pa of noise, the last one four minutes before the end.
  const auto weather = [](double t) { return 94'200.0 + 0.025 * t; };
  const auto moved = sampled(0.0, 3600.0, 0.1, 0.1, 5, [&](double t) { return weather(t) - 200.0; });
  const auto rows = sampled(30.0, 3360.0, 60.0, 3.0, 6, weather);
  const FilteredPressure base = smooth_weather(rows);
  // The median of the second differences of 55 rows is accurate to 20 %.
  CHECK(base.sigma_pa == doctest::Approx(3.0).epsilon(0.4).scale(0.0));
  const HeightSeries series = height_difference(filter_log(moved, 1.0), base, kAirK);
  double largest_m = 0.0;
  double sum_m = 0.0;
  double squares = 0.0;
  const double expected_m = hypsometric_height_m(94'200.0, 94'000.0, kAirK);
  for (const double height_m : series.heights_m) {
    largest_m = std::max(largest_m, std::abs(height_m - expected_m));
    sum_m += height_m;
    squares += height_m * height_m;
  }
  const auto count = static_cast<double>(series.heights_m.size());
  // About ten rows are averaged: 1 Pa of noise remains, 9 cm, twice that at the ends.
  CHECK(std::sqrt(squares / count - std::pow(sum_m / count, 2)) < 0.12);
  CHECK(largest_m < 0.4);
}

TEST_CASE("the smoother is the least-squares solution of its own model") {
  // Three rows, the first and the last on a line: by symmetry the middle is pulled towards it, and the mean
  // of all three is preserved.
  std::vector<PressureSample> rows(3);
  for (std::size_t i = 0; i < 3; ++i)
    rows[i].stamp_ns = kStartNs + 60'000'000'000 * static_cast<std::int64_t>(i);
  rows[0].pressure_pa = rows[2].pressure_pa = 1e5;
  rows[1].pressure_pa = 1e5 + 9.0;
  WeatherModel model;
  model.rate_sigma_pa_s = 1e-9;
  // A walk alone: minimise sum (p - x)^2 / 9 + (x1 - x0)^2 / q + (x2 - x1)^2 / q, q = 60 walk^2. With
  // a = 9 / q: x0 = x2 = a x1 / (1 + a), x1 = 9 (1 + a) / (1 + 3 a).
  const double a = 9.0 / (60.0 * model.walk_pa_sqrt_s * model.walk_pa_sqrt_s);
  const FilteredPressure smooth = smooth_weather(rows, model);
  REQUIRE(smooth.pressures_pa.size() == 5);
  const double middle_pa = 9.0 * (1.0 + a) / (1.0 + 3.0 * a);
  // The uninformative prior of the level, 1e4 Pa, contributes 1e-7 of the noise.
  CHECK(smooth.pressures_pa[2] - 1e5 == doctest::Approx(middle_pa).epsilon(1e-5).scale(0.0));
  CHECK(smooth.pressures_pa[1] - 1e5 == doctest::Approx(a * middle_pa / (1.0 + a)).epsilon(1e-5).scale(0.0));
  CHECK(smooth.pressures_pa[3] == doctest::Approx(smooth.pressures_pa[1]));
  CHECK(smooth.pressures_pa[4] == doctest::Approx(smooth.pressures_pa[3]));
}

}  // namespace isobar::test::test_height_difference
