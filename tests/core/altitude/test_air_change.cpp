// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/air_change.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

namespace isobar::test::test_air_change {

namespace {

using Pressure = std::function<double(double)>;

double still(double /*t*/) { return 0.0; }

/// Suspect after `duration_s`, and the time at which it was named first; 8 Hz with 0.2 Pa of noise.
struct Outcome {
  DriftSuspect suspect = DriftSuspect::kNone;
  double named_s = 1e9;
};

Outcome run(const Pressure& robot_pa, const Pressure& base_pa, double duration_s = 60.0) {
  AirChange change;
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 0.2);
  Outcome outcome;
  for (double t = 0.0; t < duration_s; t += 0.125) {
    const auto stamp_ns = static_cast<std::int64_t>(t * 1e9);
    change.add(stamp_ns, std::log(101'000.0 + robot_pa(t) + noise(random)),
               std::log(101'100.0 + base_pa(t) + noise(random)));
    outcome.suspect = change.suspect();
    if (outcome.suspect != DriftSuspect::kNone) outcome.named_s = std::min(outcome.named_s, t);
  }
  return outcome;
}

}  // namespace

TEST_CASE("a drift of one barometer of 0.5 Pa/s and more is named within 15 s, one of 5 Pa/s within 3") {
  for (const double rate_pa_s : {0.5, 1.0, 5.0, -0.5, -5.0}) {
    CAPTURE(rate_pa_s);
    const Pressure drift = [=](double t) { return rate_pa_s * std::max(0.0, t - 20.0); };
    const auto robot = run(drift, still);
    const auto base = run(still, drift);
    CHECK(robot.suspect == DriftSuspect::kRobot);
    CHECK(base.suspect == DriftSuspect::kBase);
    const double limit_s = 20.0 + (std::abs(rate_pa_s) > 2.0 ? 3.0 : 15.0);
    CHECK(robot.named_s > 20.0);
    CHECK(base.named_s > 20.0);
    CHECK(robot.named_s < limit_s);
    CHECK(base.named_s < limit_s);
  }
}

TEST_CASE(
    "what both barometers feel is no drift, and neither is weather, a quiet gust or a door of a second") {
  const Pressure storm = [](double t) { return 2.0 * t + 6.0 * std::sin(t); };
  CHECK(run(storm, storm).named_s > 1e8);
  CHECK(run([](double t) { return 0.04 * t; }, still).named_s > 1e8);
  CHECK(run(still, [](double t) { return std::sin(1.3 * t); }).named_s > 1e8);
  CHECK(run([](double t) { return t > 30.0 && t < 31.0 ? 3.0 : 0.0; }, still).named_s > 1e8);
}

TEST_CASE("a change is the difference of means of a second, and ends with a gap") {
  AirChange change;
  for (int i = 0; i <= 88; ++i) {
    const double t = 0.125 * i;
    change.add(static_cast<std::int64_t>(t * 1e9), std::log(1e5 + 2.0 * t), std::log(1e5 - t));
  }
  const auto over = change.over(8);
  CHECK(over.over_s == doctest::Approx(8.0));
  CHECK(over.robot_pa == doctest::Approx(16.0).epsilon(1e-3));
  CHECK(over.base_pa == doctest::Approx(-8.0).epsilon(1e-3));
  CHECK(change.suspect() == DriftSuspect::kUnknown);
  change.add(30'000'000'000, std::log(1e5), std::log(1e5));
  CHECK(change.over(8).over_s == 0.0);
  CHECK(change.suspect() == DriftSuspect::kNone);
}

}  // namespace isobar::test::test_air_change
