// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/calibration/staircase.hpp"

namespace isobar::test::test_staircase {

namespace {

constexpr double kRateHz = 32.0;

struct Stairs {
  HeightTrack track;
  std::vector<double> times_s;
};

/// Levels of the given durations, each followed by a step up (+1) or down (-1); white noise of a pair of
/// DPS310: 4.2 cm per sample.
Stairs stairs(const std::vector<double>& dwells_s, const std::vector<int>& directions, double step_m,
              double sigma_m, double drift_m_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma_m);
  Stairs result;
  double time_s = 50.0;
  double level_m = 2.0;
  for (std::size_t i = 0; i < dwells_s.size(); ++i) {
    const double end_s = time_s + dwells_s[i];
    for (; time_s < end_s; time_s += 1.0 / kRateHz) {
      result.track.times_s.push_back(time_s);
      result.track.heights_m.push_back(level_m + drift_m_s * time_s + normal(random));
    }
    if (i >= directions.size()) break;
    result.times_s.push_back(time_s);
    level_m += directions[i] * step_m;
  }
  return result;
}

double worst_s(const std::vector<double>& found, const std::vector<double>& truth) {
  REQUIRE(found.size() == truth.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] - truth[i]));
  return worst;
}

const std::vector<int> kUp(10, 1);
const std::vector<double> kUneven{9.0, 6.0, 20.0, 12.0, 7.0, 15.0, 5.5, 11.0, 18.0, 8.0, 13.0};

}  // namespace

TEST_CASE("ten steps of 3 cm are found in the white noise of two DPS310, at any duration of the levels") {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const Stairs up = stairs(kUneven, kUp, 0.03, 0.042, 0.0, seed);
    const FoundSteps found = find_steps(up.track, {0.03, 10});
    // sqrt(26) (4.2 / 3)^2 / 32 Hz; the worst of forty is about four sigmas of this long-tailed distribution.
    CHECK(found.uncertainty_s == doctest::Approx(std::sqrt(26.0) * 1.96 / 32.0).epsilon(0.15).scale(0.0));
    CHECK(worst_s(found.times_s, up.times_s) < 1.5);
    CHECK(worst_s(find_steps(up.track, {0.03}).times_s, up.times_s) < 1.5);
  }
}

TEST_CASE("steps down, reversing steps, and steps under sensor drift are found, too") {
  const Stairs down = stairs(kUneven, std::vector<int>(10, -1), 0.03, 0.03, 0.0, 5);
  CHECK(worst_s(find_steps(down.track, {0.03}).times_s, down.times_s) < 1.0);
  const Stairs turning = stairs(kUneven, {1, 1, -1, 1, -1, -1, 1, -1, 1, 1}, 0.13, 0.042, 0.0, 6);
  CHECK(worst_s(find_steps(turning.track, {0.13}).times_s, turning.times_s) < 0.2);
  const Stairs fine = stairs(kUneven, {1, -1, 1, -1, 1, -1, 1, -1, 1, -1}, 0.03, 0.042, 0.0, 16);
  CHECK(worst_s(find_steps(fine.track, {0.03}).times_s, fine.times_s) < 1.5);
  // 1 cm a minute: a barometer warming up by half a kelvin.
  const Stairs drifting = stairs(kUneven, kUp, 0.03, 0.03, 1.7e-4, 7);
  CHECK(worst_s(find_steps(drifting.track, {0.03}).times_s, drifting.times_s) < 1.0);
}

TEST_CASE("no steps are found where there are none, and noise that hides them shows in the uncertainty") {
  const Stairs still = stairs({120.0}, {}, 0.03, 0.042, 0.0, 8);
  CHECK(find_steps(still.track, {0.03}).times_s.empty());
  CHECK(find_steps({}, {0.03}).times_s.empty());
  const Stairs hidden = stairs(kUneven, kUp, 0.03, 0.3, 0.0, 9);
  CHECK(find_steps(hidden.track, {0.03}).uncertainty_s > 5.0);
}

TEST_CASE("errors of a staircase equal those computed by hand") {
  // Levels read 1.00, 1.04, 1.06 where steps are 3 cm: errors +1 cm, -1 cm.
  HeightTrack track;
  for (int i = 0; i < 300; ++i) {
    track.times_s.push_back(0.1 * i);
    const double noise_m = i % 2 == 0 ? 0.002 : -0.002;
    track.heights_m.push_back((i < 100 ? 1.0 : i < 200 ? 1.04 : 1.06) + noise_m);
  }
  const std::vector<double> steps{9.95, 19.95};
  const auto plateaus = plateaus_between(track, steps, 0.03, 1.0, 2.0);
  REQUIRE(plateaus.size() == 3);
  CHECK(plateaus[1].begin_s == doctest::Approx(10.95));
  CHECK(plateaus[1].end_s == doctest::Approx(17.95));
  CHECK(plateaus[2].true_height_m == doctest::Approx(0.06));
  const StaircaseErrors errors = staircase_errors(track, plateaus);
  REQUIRE(errors.steps_m.size() == 2);
  // An odd number of samples leaves 2 mm / 70 in the mean.
  CHECK(errors.steps_m[0] == doctest::Approx(0.01).epsilon(0.01).scale(0.0));
  CHECK(errors.steps_m[1] == doctest::Approx(-0.01).epsilon(0.01).scale(0.0));
  CHECK(errors.samples_m.size() == 70 + 89);  // the end of a span is exclusive
  for (const double error_m : errors.samples_m) {
    CHECK(std::abs(std::abs(error_m) - 0.01) == doctest::Approx(0.002).epsilon(0.05).scale(0.0));
  }
  // A plateau shortened to nothing is left out.
  CHECK(staircase_errors(track, shortened(plateaus, 6.0, 3.0)).steps_m.empty());
}

TEST_CASE("the figures of normal errors are 0.674 and 0.603 sigma") {
  std::mt19937 random(10);
  std::normal_distribution<double> normal(0.0, 0.02);
  std::vector<double> errors(100'000);
  for (double& error : errors) error = normal(random);
  const ErrorFigures figures = error_figures(errors);
  CHECK(figures.count == 100'000);
  CHECK(figures.median_m == doctest::Approx(0.6745 * 0.02).epsilon(0.02).scale(0.0));
  CHECK(figures.sd_m == doctest::Approx(0.6028 * 0.02).epsilon(0.02).scale(0.0));
  CHECK(std::isnan(error_figures({}).median_m));
}

}  // namespace isobar::test::test_staircase
