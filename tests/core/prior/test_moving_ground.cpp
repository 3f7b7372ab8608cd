// SPDX-License-Identifier: BSD-3-Clause
// The parts of HeightFilter on their own: forks, moving ground, a step of the pressure.
#include <doctest/doctest.h>

#include <cmath>

#include "core/prior/filter_forks.hpp"
#include "core/prior/moving_ground.hpp"
#include "core/prior/pressure_step.hpp"

namespace isobar::test::test_moving_ground {

namespace {

constexpr double kDtS = 0.005;
constexpr double kDensity = 1e-5;
constexpr double kClimbVariance = 1e-4;
using Event = MovingGround::Event;

/// A robot whose filter believes the wheels, as HeightFilter does.
struct Rig {
  HeightConfig config;
  VerticalFilter filter{config};
  FilterForks forks{config};
  MovingGround ground{config};

  Rig() {
    filter.start(0.0, 0.01);
    forks.restart(filter);
  }

  Event step(double accel_m_s2, double wheels_climb_m_s, double forward_m_s = 0.0) {
    filter.predict(accel_m_s2, kDtS, kDensity, false);
    forks.predict(filter, accel_m_s2, kDtS, kDensity, false);
    ground.add_acceleration(accel_m_s2, kDtS);
    const WheelClimb wheels{wheels_climb_m_s, forward_m_s, kClimbVariance, kDtS};
    const Event event = ground.add_climb(wheels, forks, filter);
    if (event == Event::kBegins) filter = forks.older();
    if (event == Event::kForkWrong || event == Event::kEnds) {
      forks.restart(filter);
      ground.forks_restarted();
    }
    if (!ground.moves()) filter.update_climb(wheels_climb_m_s, forward_m_s, kClimbVariance / kDtS);
    return event;
  }

  int count(double seconds, double accel_m_s2, double wheels_climb_m_s, Event wanted,
            double forward_m_s = 0.0) {
    int seen = 0;
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kDtS)); ++i) {
      seen += step(accel_m_s2, wheels_climb_m_s, forward_m_s) == wanted ? 1 : 0;
    }
    return seen;
  }
};

}  // namespace

TEST_CASE("one fork always predates the last second and a half") {
  Rig rig;
  rig.count(FilterForks::kLifeS, 0.0, 0.0, Event::kNone);
  double youngest_s = FilterForks::kLifeS;
  double oldest_s = 0.0;
  for (int i = 0; i < 4000; ++i) {
    rig.step(0.0, 0.0);
    youngest_s = std::min(youngest_s, rig.forks.age_s());
    oldest_s = std::max(oldest_s, rig.forks.age_s());
  }
  // Within one step of the limits.
  CHECK(youngest_s >= 0.5 * FilterForks::kLifeS - kDtS);
  CHECK(oldest_s <= FilterForks::kLifeS);
  CHECK(oldest_s >= FilterForks::kLifeS - 2.0 * kDtS);
}

TEST_CASE("a fork keeps the speed that the wheels take from the filter") {
  Rig rig;
  rig.count(2.0, 0.0, 0.0, Event::kNone);
  for (int i = 0; i < 200; ++i) {
    rig.filter.predict(0.5, kDtS, kDensity, false);
    rig.forks.predict(rig.filter, 0.5, kDtS, kDensity, false);
    rig.filter.update_climb(0.0, 0.0, kClimbVariance);
  }
  CHECK(std::abs(rig.forks.older().value(VerticalFilter::kVz) - 0.5) < 0.01);
  CHECK(rig.filter.value(VerticalFilter::kVz) < 0.8 * rig.forks.older().value(VerticalFilter::kVz));
}

TEST_CASE("a ride begins while the wheels stand, and ends when it stops") {
  Rig rig;
  CHECK(rig.count(4.0, 0.0, 0.0, Event::kBegins) == 0);
  // An elevator: 1 m/s after 1 s, 5 s of steady speed, 1 s of braking.
  CHECK(rig.count(1.0, 1.0, 0.0, Event::kBegins) == 1);
  CHECK(rig.ground.moves());
  CHECK(rig.count(5.0, 0.0, 0.0, Event::kEnds) == 0);
  rig.count(1.0, -1.0, 0.0, Event::kEnds);
  CHECK(rig.count(3.0, 0.0, 0.0, Event::kEnds) == 1);
  CHECK(!rig.ground.moves());
  // 6 m, by acceleration alone: 8 s of its noise are 3 cm.
  CHECK(std::abs(rig.filter.value(VerticalFilter::kZ) - 6.0) < 0.1);
}

TEST_CASE("a bump and a ramp that the wheels climb are no ride") {
  Rig rig;
  rig.count(4.0, 0.0, 0.0, Event::kNone);
  // A threshold at 1 m/s: up for 50 ms, down for 50 ms.
  CHECK(rig.count(0.05, 4.0, 0.0, Event::kBegins, 1.0) == 0);
  CHECK(rig.count(0.05, -4.0, 0.0, Event::kBegins, 1.0) == 0);
  // A ramp of 10 %, from rest to 1 m/s within 1 s.
  int begun = 0;
  for (int i = 0; i < 200; ++i) begun += rig.step(0.1, 0.1 * i * kDtS, i * kDtS) == Event::kBegins ? 1 : 0;
  begun += rig.count(5.0, 0.0, 0.1, Event::kBegins, 1.0);
  CHECK(begun == 0);
}

TEST_CASE("vibration that a fork integrates, and the pressure contradicts, is no ride") {
  Rig rig;
  rig.count(4.0, 0.0, 0.0, Event::kNone);
  rig.ground.add_pressure(0.4, 0.02);
  int wrong = 0;
  for (int i = 0; i < 200; ++i) {
    rig.ground.add_pressure(0.4, 0.02);
    const Event event = rig.step(0.6, 0.0);
    CHECK(event != Event::kBegins);
    wrong += event == Event::kForkWrong ? 1 : 0;
  }
  CHECK(wrong >= 1);
  CHECK(!rig.ground.moves());
}

TEST_CASE("without a step of the pressure heights pass unchanged; with one the scale of later climbs stays") {
  PressureStep step;
  AltimeterReading reading;
  reading.scale_m = 8400.0;
  const auto height_of = [&](double pressure_ratio) { return -reading.scale_m * std::log(pressure_ratio); };
  const auto ratio_at = [&](double height_m) { return std::exp(-height_m / reading.scale_m); };
  reading.height_m = 12.5;
  CHECK(step.height_without_m(reading) == reading.height_m);
  // A sensor that loses 20 % of the pressure at 10 m.
  constexpr double kLost = 0.2;
  reading.height_m = height_of(ratio_at(10.0) - kLost);
  step.open(reading, 10.0);
  for (const double true_m : {10.0, 0.0, 60.0}) {
    reading.height_m = height_of(ratio_at(true_m) - kLost);
    CHECK(std::abs(step.height_without_m(reading) - true_m) < 1e-9);
  }
  // Subtracted as a height the step would make 50 m of climb too long by a quarter.
  reading.height_m = height_of(ratio_at(60.0) - kLost);
  const double at_60_m = reading.height_m;
  reading.height_m = height_of(ratio_at(10.0) - kLost);
  CHECK(at_60_m - reading.height_m > 1.2 * 50.0);
  step.close();
  CHECK(step.height_without_m(reading) == reading.height_m);
}

TEST_CASE("a step beyond the whole pressure leaves a finite height") {
  PressureStep step;
  AltimeterReading reading;
  reading.scale_m = 8400.0;
  reading.height_m = -20'000.0;
  step.open(reading, 0.0);
  reading.height_m = 0.0;
  CHECK(std::isfinite(step.height_without_m(reading)));
}

}  // namespace isobar::test::test_moving_ground
