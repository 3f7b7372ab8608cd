// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/calibration/allan_deviation.hpp"
#include "core/calibration/still_period.hpp"

namespace isobar::test::test_allan {

namespace {

constexpr double kDt = 1.0 / 32.0;

/// A still sensor: white noise, random walk, ramp.
std::vector<double> still_sensor(std::size_t count, double sigma, double walk, double ramp, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(count);
  double level = 101'325.0;
  for (double& value : values) {
    level += walk * std::sqrt(kDt) * normal(random) + ramp * kDt;
    value = level + sigma * normal(random);
  }
  return values;
}

/// Slope of log deviation over log tau between the points nearest to two averaging times.
double slope(const std::vector<AllanPoint>& points, double from_s, double to_s) {
  const auto nearest = [&](double tau_s) {
    const AllanPoint* best = &points.front();
    for (const AllanPoint& point : points) {
      if (std::abs(std::log(point.tau_s / tau_s)) < std::abs(std::log(best->tau_s / tau_s))) best = &point;
    }
    return *best;
  };
  const AllanPoint a = nearest(from_s);
  const AllanPoint b = nearest(to_s);
  return std::log(b.deviation / a.deviation) / std::log(b.tau_s / a.tau_s);
}

}  // namespace

TEST_CASE("the Allan deviation of a short series equals the value computed by hand") {
  // Means of one: differences 2, -1, 3 -> (4 + 1 + 9) / (2 * 3). Means of two: 2, 2.5, 3.5 -> 1.5^2 / 2.
  const std::vector<double> values{1.0, 3.0, 2.0, 5.0};
  const auto points = overlapping_allan(values, 0.5);
  REQUIRE(points.size() == 2);
  CHECK(points[0].tau_s == 0.5);
  CHECK(points[0].deviation == doctest::Approx(std::sqrt(14.0 / 6.0)));
  CHECK(points[1].samples == 2);
  CHECK(points[1].deviation == doctest::Approx(std::sqrt(1.125)));
  CHECK(overlapping_allan(std::vector<double>{1.0}, 0.5).empty());
}

TEST_CASE("white noise falls with slope -1/2, and is the only part that is identified") {
  const auto points = overlapping_allan(still_sensor(100'000, 0.35, 0.0, 0.0, 1), kDt);
  // 100 000 samples average 32 s a hundred times: a slope over three decades is good to 0.02.
  CHECK(slope(points, kDt, 30.0) == doctest::Approx(-0.5).epsilon(0.05).scale(0.0));
  CHECK(points.front().deviation == doctest::Approx(0.35).epsilon(0.01).scale(0.0));
  const AllanNoise noise = identify_noise(points);
  CHECK(noise.white / std::sqrt(kDt) == doctest::Approx(0.35).epsilon(0.01).scale(0.0));
  // The other parts are below the white noise of the longest useful average, 0.35 / sqrt(3e4).
  CHECK(0.664 * noise.bias_instability < 0.004);
  CHECK(noise.walk * std::sqrt(100.0 / 3.0) < 0.01);
}

TEST_CASE("a random walk rises with slope +1/2 and agrees with its closed form") {
  const auto points = overlapping_allan(still_sensor(100'000, 0.0, 0.06, 0.0, 2), kDt);
  CHECK(slope(points, 0.5, 20.0) == doctest::Approx(0.5).epsilon(0.1).scale(0.0));
  // One sample apart: half of the variance of a step. Many: K sqrt(tau / 3).
  CHECK(points.front().deviation == doctest::Approx(0.06 * std::sqrt(0.5 * kDt)).epsilon(0.01).scale(0.0));
  const AllanNoise noise = identify_noise(points);
  CHECK(noise.walk == doctest::Approx(0.06).epsilon(0.03).scale(0.0));
  CHECK(noise.white / std::sqrt(kDt) < 0.003);
}

TEST_CASE("a ramp alone has the deviation R tau / sqrt(2), and is not identified as a walk") {
  const auto points = overlapping_allan(still_sensor(4'000, 0.0, 0.0, 0.03, 3), kDt);
  for (const AllanPoint& point : points) {
    // Sums of 4000 values of 1e5 Pa keep eight digits.
    CHECK(point.deviation ==
          doctest::Approx(0.03 * point.tau_s / std::numbers::sqrt2).epsilon(1e-5).scale(0.0));
  }
  const AllanNoise noise = identify_noise(points);
  CHECK(noise.ramp == doctest::Approx(0.03).epsilon(1e-4).scale(0.0));
  CHECK(noise.walk < 1e-3);
}

TEST_CASE("white noise, walk and weather are separated in one series, and the model fits the points") {
  const auto points = overlapping_allan(still_sensor(200'000, 0.35, 0.02, 0.01, 4), kDt);
  const AllanNoise noise = identify_noise(points);
  CHECK(noise.white / std::sqrt(kDt) == doctest::Approx(0.35).epsilon(0.02).scale(0.0));
  // The walk dominates between 10 and 30 s only, with some 300 independent averages: 10 %, times two.
  CHECK(noise.walk == doctest::Approx(0.02).epsilon(0.2).scale(0.0));
  CHECK(noise.ramp == doctest::Approx(0.01).epsilon(0.1).scale(0.0));
  for (const AllanPoint& point : points) {
    if (point.uncertainty > 0.1) continue;
    CHECK(modelled_deviation(noise, point) ==
          doctest::Approx(point.deviation).epsilon(0.02 + 2.0 * point.uncertainty).scale(0.0));
  }
}

TEST_CASE("bias instability is identified as a floor, not as white noise or a walk") {
  // A sum of Gauss-Markov processes, time constants an octave apart, is flicker noise between their ends.
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> state(12, 0.0);
  std::vector<double> values(200'000);
  for (double& value : values) {
    value = 0.0;
    for (std::size_t k = 0; k < state.size(); ++k) {
      const double keep = std::exp(-1.0 / std::pow(2.0, static_cast<double>(k)));
      state[k] = keep * state[k] + 0.1 * std::sqrt(1.0 - keep * keep) * normal(random);
      value += state[k];
    }
  }
  const auto points = overlapping_allan(values, kDt);
  CHECK(std::abs(slope(points, 10.0 * kDt, 300.0 * kDt)) < 0.1);
  const AllanNoise noise = identify_noise(points);
  const double floor = 0.664 * noise.bias_instability;
  for (const AllanPoint& point : points) {
    if (point.samples < 10 || point.samples > 300) continue;
    CHECK(point.deviation == doctest::Approx(floor).epsilon(0.15).scale(0.0));
  }
}

TEST_CASE("the robust sigma is insensitive to motion, doors and spikes") {
  std::vector<double> values = still_sensor(4'000, 0.35, 0.0, 0.0, 6);
  // 0.0139 is the standard deviation of a median of 4000: 1.17 / sqrt(4000), slightly more for the overlap.
  CHECK(robust_sigma(values) == doctest::Approx(0.35).epsilon(0.06).scale(0.0));
  for (std::size_t i = 1000; i < 3000; ++i) values[i] -= 0.2 * static_cast<double>(i - 1000);  // 0.5 m/s up
  for (std::size_t i = 0; i < values.size(); i += 100) values[i] += 500.0;
  CHECK(robust_sigma(values) == doctest::Approx(0.35).epsilon(0.12).scale(0.0));
  CHECK(robust_sigma(std::vector<double>{1.0, 2.0}) == 0.0);
}

TEST_CASE("the longest still period ends at a rise of the sensor, not in a storm") {
  // 40 s still, 10 s up by 5 m, then 80 s still in a storm of 100 Pa an hour.
  std::vector<double> values = still_sensor(130 * 32, 0.35, 0.0, -100.0 / 3600.0, 7);
  std::vector<double> times(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    times[i] = 1000.0 + static_cast<double>(i) * kDt;
    values[i] -= 12.0 * std::clamp(0.1 * (times[i] - 1040.0), 0.0, 1.0) * 5.0;
  }
  const StillPeriod still = longest_still_period(times, values, 0.35);
  // Found to one window of 5 s.
  CHECK(times[still.begin] >= 1050.0);
  CHECK(times[still.begin] <= 1055.1);
  CHECK(still.end == values.size());
  // A gap ends it as well.
  for (std::size_t i = 90 * 32; i < times.size(); ++i) times[i] += 60.0;
  const StillPeriod cut = longest_still_period(times, values, 0.35);
  CHECK((cut.end <= 91 * 32 || cut.begin >= 89 * 32));
  CHECK(longest_still_period({}, {}, 0.35).count() == 0);
}

}  // namespace isobar::test::test_allan
