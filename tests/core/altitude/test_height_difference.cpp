// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/altitude/height_difference.hpp"
#include "core/altitude/hypsometry.hpp"

using namespace isobar;

namespace {

constexpr double kAirK = 290.0;
constexpr std::int64_t kStartNs = 1'760'000'000'000'000'000;

/// Samples `dt_s` apart of a pressure as a function of time.
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

TEST_CASE("without a filter the difference is the hypsometric height, whatever the weather does in common") {
  const auto weather = [](double t) { return 101'000.0 + 50.0 * std::sin(0.05 * t); };
  const auto moved = sampled(0.0, 60.0, 1.0 / 32.0, 0.0, 1,
                             [&](double t) { return hypsometric_pressure_pa(weather(t), 0.1 * t, kAirK); });
  const auto standing = sampled(0.011, 60.0, 1.0 / 32.0, 0.0, 2, weather);
  const HeightSeries series = height_difference(filter_log(moved, 0.0), filter_log(standing, 0.0), kAirK);
  REQUIRE(series.heights_m.size() == moved.size());
  for (std::size_t i = 0; i < series.heights_m.size(); ++i) {
    const double t = seconds(series.stamps_ns[i]);
    if (t < 0.1 || t > 59.9) continue;  // beyond the standing sensor's samples
    // Interpolating over 31 ms of this weather costs 50 (0.05)^2 (0.031)^2 / 8 Pa.
    CHECK(series.heights_m[i] == doctest::Approx(0.1 * t).epsilon(1e-5).scale(0.0));
  }
}

TEST_CASE("through equal low-passes drafts that reach both sensors cancel, and a climb is on time") {
  // A draft of 20 Pa in 4 s: a low-pass on one side only would leave metres of it.
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
  // White noise of 0.5 Pa, less by sqrt(K / (2 - K)) = 0.12 and 8.4 cm/Pa: 0.53 cm. The draft adds what the
  // interpolation between the stamps of the two sensors leaves of it.
  CHECK(std::sqrt(squares / count) < 0.008);
  const HeightSeries raw = height_difference(filter_log(moved, 0.0), filter_log(standing, lag_s), kAirK);
  double largest = 0.0;
  for (std::size_t i = raw.heights_m.size() / 2; i < raw.heights_m.size() - 64; ++i) {
    largest = std::max(largest, std::abs(raw.heights_m[i] - 0.25 * seconds(raw.stamps_ns[i])));
  }
  CHECK(largest > 0.5);
}

TEST_CASE("a base of one row a minute is smoothed over rows, and held beyond them") {
  const auto moved = sampled(0.0, 3600.0, 0.1, 0.1, 5, [](double t) { return 94'000.0 + 0.02 * t; });
  const auto rows = sampled(-1800.0, 5400.0, 60.0, 3.0, 6, [](double t) { return 94'200.0 + 0.02 * t; });
  const FilteredPressure base = filter_log(rows, 1.0, 1.0);
  CHECK(base.design.output_sigma_pa == doctest::Approx(1.0));
  const HeightSeries series = height_difference(filter_log(moved, 1.0), base, kAirK);
  double sum = 0.0;
  double squares = 0.0;
  for (const double height_m : series.heights_m) {
    sum += height_m;
    squares += height_m * height_m;
  }
  const auto count = static_cast<double>(series.heights_m.size());
  const double deviation_m = std::sqrt(squares / count - std::pow(sum / count, 2));
  // Weather of 72 Pa, 6 m, is gone; 1 Pa of the rows' noise is left, 9 cm.
  CHECK(deviation_m < 0.12);
}
