// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/altitude/drift_watch.hpp"

namespace isobar::test::test_drift_watch {

namespace {

using Air = std::function<double(double)>;

constexpr double kStartS = 60.0;
constexpr double kMetresPerPa = 0.085;

double still(double /*t*/) { return 0.0; }

struct Scene {
  Air robot_m = still;  ///< error of the altimeter by the robot's barometer
  Air base_m = still;   ///< by the base station's
  double speed_m_s = 0.0;
  bool base = true;
  double turbulence_m = 0.02;  ///< 1 sigma, over 4 s
};

struct Outcome {
  DriftSuspect suspect = DriftSuspect::kNone;  ///< the first one
  double named_s = INFINITY;
  double rate_m_s = 0.0;
  DriftSuspect last = DriftSuspect::kNone;
};

Outcome watch(const Scene& scene, double until_s = 400.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  DriftWatch watch;
  Outcome out;
  constexpr double kStepS = 0.1;
  const double keep = std::exp(-kStepS / 4.0);
  double turbulence_m = 0.0;
  for (double t = 0.0; t < until_s; t += kStepS) {
    turbulence_m = keep * turbulence_m + std::sqrt(1.0 - keep * keep) * scene.turbulence_m * normal(random);
    watch.add({.stamp_ns = 1'000'000'000 + static_cast<std::int64_t>(t * 1e9),
               .residual_m = scene.robot_m(t) + scene.base_m(t) + turbulence_m + 0.02 * normal(random),
               .base_m = scene.base_m(t),
               .way_m = scene.speed_m_s * kStepS,
               .base = scene.base});
    out.last = watch.suspect();
    if (out.last == DriftSuspect::kNone || std::isfinite(out.named_s)) continue;
    out.suspect = out.last;
    out.named_s = t;
    out.rate_m_s = watch.rate_m_s();
  }
  return out;
}

Air drift(double pa_s) {
  return [pa_s](double t) { return kMetresPerPa * pa_s * std::max(0.0, t - kStartS); };
}

}  // namespace

TEST_CASE(
    "a drift of either barometer is named within 10 s, a slow one once it is 10 cm, standing and driving") {
  int named = 0;
  for (const double pa_s : {0.01, 0.05, 0.25, 1.0, 5.0}) {
    for (const double sign : {1.0, -1.0}) {
      for (unsigned seed = 1; seed <= 5; ++seed) {
        CAPTURE(pa_s);
        CAPTURE(seed);
        const double until_10_cm_s = 0.1 / (kMetresPerPa * pa_s);
        const Outcome robot = watch({.robot_m = drift(sign * pa_s)}, 400.0, seed);
        const Outcome base = watch({.base_m = drift(sign * pa_s)}, 400.0, seed);
        CHECK(robot.suspect == DriftSuspect::kRobot);
        named += base.suspect == DriftSuspect::kBase ? 1 : 0;
        CHECK((base.suspect == DriftSuspect::kBase || base.suspect == DriftSuspect::kUnknown));
        // The turbulence is half of 10 cm from crest to trough.
        const double limit_s = kStartS + 2.0 + std::max(13.0, 2.5 * until_10_cm_s);
        CHECK(robot.named_s > kStartS);
        CHECK(robot.named_s < limit_s);
        CHECK(base.named_s < limit_s);
        CHECK(robot.rate_m_s * sign > 0.0);
      }
    }
  }
  // In turbulence of the size of the drift it may be either.
  CHECK(named > 40);
  const Outcome driving = watch({.robot_m = drift(0.25), .speed_m_s = 1.0});
  CHECK(driving.named_s < kStartS + 15.0);
  CHECK(driving.rate_m_s == doctest::Approx(kMetresPerPa * 0.25).epsilon(0.3));
}

TEST_CASE("zones, doors, gusts and turbulence are no drift") {
  // A zone of up to 4 Pa every 30 s, entered within a second.
  const Air zones = [](double t) {
    const auto zone = static_cast<int>(t / 30.0);
    const double into = std::min(1.0, std::fmod(t, 30.0));
    const auto level = [](int k) {
      return kMetresPerPa * 4.0 * std::remainder(43758.5 * std::sin(12.9898 * k), 2.0);
    };
    return level(zone - 1) + into * (level(zone) - level(zone - 1));
  };
  const Air doors = [](double t) { return std::fmod(t, 13.0) < 1.5 ? 8.0 * kMetresPerPa : 0.0; };
  const Air gusts = [](double t) { return 0.15 * std::sin(0.9 * t); };
  for (unsigned seed = 1; seed <= 10; ++seed) {
    int which = 0;
    for (const Air& air : {Air(still), zones, doors, gusts}) {
      const int air_number = which++;
      CAPTURE(air_number);
      const Outcome outcome = watch({.robot_m = air, .turbulence_m = 0.04}, 900.0, seed);
      CAPTURE(outcome.named_s);
      CAPTURE(outcome.rate_m_s);
      CHECK(outcome.suspect == DriftSuspect::kNone);
    }
  }
}

TEST_CASE("what a tilted map climbs while the robot drives is no drift") {
  const Air climb = [](double t) { return 0.003 * t; };
  CHECK(watch({.robot_m = climb, .speed_m_s = 1.0}).suspect == DriftSuspect::kNone);
  CHECK(watch({.robot_m = climb, .speed_m_s = 0.0}).suspect == DriftSuspect::kRobot);
}

TEST_CASE("without a base station weather is no drift, and a fast one is") {
  CHECK(watch({.robot_m = [](double t) { return 0.003 * t; }, .base = false}).suspect == DriftSuspect::kNone);
  CHECK(watch({.robot_m = drift(1.0), .base = false}).named_s < kStartS + 12.0);
}

TEST_CASE("both barometers that drift name neither, and a drift that has ended is over") {
  const Air both = drift(0.5);
  CHECK(watch({.robot_m = both, .base_m = both}).suspect == DriftSuspect::kUnknown);
  const Air ends = [](double t) { return drift(1.0)(std::min(t, 90.0)); };
  CHECK(watch({.robot_m = ends}, 100.0).last == DriftSuspect::kRobot);
  CHECK(watch({.robot_m = ends}, 330.0).last == DriftSuspect::kNone);
}

TEST_CASE("a gap, another reference and a clock that goes back begin a new watch") {
  DriftWatch watch;
  const auto add = [&](double t, double residual_m, bool base) {
    watch.add({.stamp_ns = 1'000'000'000'000 + static_cast<std::int64_t>(t * 1e9),
               .residual_m = residual_m,
               .base = base});
  };
  for (const double start_s : {0.0, 30.0, -100.0}) {
    for (double t = 0.0; t < 20.0; t += 0.1) add(start_s + t, 0.1 * t, true);
    CHECK(watch.suspect() == DriftSuspect::kRobot);
    add(start_s + 20.0, 2.0, false);
    CHECK(watch.suspect() == DriftSuspect::kNone);
    for (double t = 20.1; t < 26.0; t += 0.1) add(start_s + t, 2.0, true);
    CHECK(watch.suspect() == DriftSuspect::kNone);
  }
}

TEST_CASE("airflow that is not known yet is no drift") {
  DriftWatch knows;
  DriftWatch doubts;
  bool named = false;
  for (double t = 0.0; t < 60.0; t += 0.1) {
    const double speed_m_s = std::clamp(t - 30.0, 0.0, 8.0);
    DriftWatch::Reading reading{.stamp_ns = 1'000'000'000 + static_cast<std::int64_t>(t * 1e9),
                                .residual_m = 0.085 * std::clamp(t - 30.0, 0.0, 8.0),
                                .way_m = 0.1 * speed_m_s,
                                .base = true};
    knows.add(reading);
    named = named || knows.suspect() != DriftSuspect::kNone;
    reading.airflow_sd_m = 0.02 * speed_m_s * speed_m_s;
    doubts.add(reading);
    CHECK(doubts.suspect() == DriftSuspect::kNone);
  }
  CHECK(named);
}

}  // namespace isobar::test::test_drift_watch
