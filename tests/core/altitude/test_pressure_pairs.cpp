// SPDX-License-Identifier: BSD-3-Clause
// Simultaneous pressures of robot and base station, in closed form.
#include "core/altitude/pressure_pairs.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "core/altitude/differential_altimeter.hpp"
#include "core/altitude/hypsometry.hpp"
#include "tests/core/altitude/isothermal_air.hpp"

namespace isobar::test::test_pressure_pairs {

namespace {

constexpr double kAirK = 293.15;

std::int64_t at(double t) { return static_cast<std::int64_t>(std::llround(t * 1e9)) + 1'000'000'000; }

struct Scene {
  std::function<double(double)> common_pa = [](double) { return 0.0; };
  std::function<double(double)> base_pa = [](double) { return 0.0; };  ///< drift of the base station alone
  std::function<double(double)> height_m = [](double) { return 0.0; };
  double base_hz = 1.0;
  double base_delay_s = 0.0;
};

struct Outcome {
  double error_m = 0.0;  ///< largest, after 5 s, beyond that of the base station's first value
  int heights = 0;
  int faults = 0;
  double base_air_m = 0.0;  ///< the base station's part of the last height
};

Outcome run(const Scene& scene) {
  AltimeterConfig config;
  config.air.mode = AirTemperatureMode::kFixed;
  DifferentialAltimeter altimeter(config);
  Outcome outcome;
  double next_base_s = 0.05;
  double offset_m = 0.0;
  for (int i = 0; i < 32 * 60; ++i) {
    const double t = i / 32.0;
    altimeter.set_time(at(t));
    for (; next_base_s + scene.base_delay_s <= t; next_base_s += 1.0 / scene.base_hz) {
      const double pa = 101'000.0 + scene.common_pa(next_base_s) + scene.base_pa(next_base_s) +
                        1e-7 * std::sin(next_base_s);
      altimeter.add_base({at(next_base_s), pa, 20.0});
    }
    altimeter.set_climb(scene.height_m(t));
    AltimeterReading reading;
    const double pa = hypsometric_pressure_pa(101'000.0 + scene.common_pa(t), scene.height_m(t), kAirK) +
                      1e-7 * std::sin(t);
    if (altimeter.add_robot({at(t), pa, 20.0}, reading) != PressureStatus::kAccepted) continue;
    if (t > 5.0) outcome.faults += altimeter.base_fault(0) != BarometerFault::kOk ? 1 : 0;
    const double error_m = reading.height_m + reading.climb_since_m - scene.height_m(t);
    if (t < 5.0) {
      if (reading.complete) offset_m = error_m;  // of the base station's first value
      continue;
    }
    if (!reading.complete) continue;
    ++outcome.heights;
    outcome.base_air_m = reading.base_air_m;
    CHECK(reading.source == HeightSource::kDifferential);
    outcome.error_m = std::max(outcome.error_m, std::abs(error_m - offset_m));
  }
  return outcome;
}

double ramp_pa(double t) { return t > 2.0 ? t - 2.0 : 0.0; }
double gusts_pa(double t) { return 3.0 * std::sin(2.0 * M_PI * 0.2 * t); }
double ride_m(double t) { return t > 20.0 ? std::min(t - 20.0, 25.0) : 0.0; }

}  // namespace

TEST_CASE("what is common to both barometers cancels, at any rate and delay of the base station") {
  for (const double hz : {1.0, 4.0, 32.0, 100.0}) {
    for (const double delay_s : {0.0, 0.9}) {
      for (const bool rides : {false, true}) {
        for (const auto& common : {ramp_pa, gusts_pa}) {
          CAPTURE(hz);
          CAPTURE(delay_s);
          CAPTURE(rides);
          Scene scene;
          scene.base_hz = hz;
          scene.base_delay_s = delay_s;
          scene.common_pa = common;
          if (rides) scene.height_m = ride_m;
          const Outcome outcome = run(scene);
          // Robot's pressure between two samples, 3 Pa (2 pi 0.2 Hz / 32 Hz)^2 / 8 = 0.6 mPa, and curvature of
          // exp() at 25 m: well below a millimetre. 4 Pa of ramp at 25 m are 1 %: one scale for both ends.
          CHECK(outcome.error_m < 2e-3);
          CHECK(outcome.faults == 0);
          // One height a sample of the slower barometer, at most one in four samples of 32 Hz.
          CHECK(outcome.heights == doctest::Approx(55.0 * std::min(hz, 8.0)).epsilon(0.05));
        }
      }
    }
  }
}

TEST_CASE("a drift of the base station alone is its part of the height, also while the robot rides") {
  Scene scene;
  scene.base_hz = 4.0;
  scene.height_m = ride_m;
  scene.base_pa = [](double t) { return t > 30.0 ? -0.8 * (t - 30.0) : 0.0; };
  const double drifted_m = -0.8 * 30.0 * hypsometric_scale_m(kAirK) / 101'000.0;
  CHECK(run(scene).base_air_m == doctest::Approx(drifted_m).epsilon(0.05));
}

TEST_CASE("the mean of a pair's noise is that of linear interpolation, and of the number of base samples") {
  PressurePairs pairs;
  PressurePairs::Mean mean;
  CHECK_FALSE(pairs.add_robot(at(-1.0), 1.0, 0.0, mean));
  pairs.add_base(at(0.0), 1.0, 0.5);
  CHECK(pairs.add_robot(at(0.0), 1.0, 0.0, mean));
  CHECK(mean.robot_share == doctest::Approx(1.0));
  pairs.add_base(at(0.1), 3.0, 0.5);
  pairs.add_base(at(0.3), 5.0, 0.5);
  pairs.add_base(at(0.5), 9.0, 0.5);  // after the robot's next sample: waits
  REQUIRE(pairs.add_robot(at(0.4), 2.0, 4.0, mean));
  // Robot at 0.1 s: 1.25, 1 m; at 0.3 s: 1.75, 3 m.
  CHECK(mean.difference_log == doctest::Approx(0.5 * (3.0 - 1.25 + 5.0 - 1.75)));
  CHECK(mean.climb_m == doctest::Approx(2.0));
  CHECK(mean.delay_s == doctest::Approx(0.2));
  CHECK(mean.robot_share == doctest::Approx(0.75 * 0.75 + 0.25 * 0.25));
  CHECK(mean.base_variance == doctest::Approx(0.25));
  CHECK_FALSE(pairs.add_robot(at(0.45), 2.0, 4.0, mean));
  CHECK(pairs.add_robot(at(0.5), 2.0, 4.0, mean));
}

TEST_CASE("a mean over four samples of both barometers has a quarter of their variance, nearly") {
  PressurePairs pairs;
  PressurePairs::Mean mean;
  pairs.add_base(at(0.0), 0.0, 1.0);
  REQUIRE(pairs.add_robot(at(0.0), 0.0, 0.0, mean));
  for (int i = 1; i <= 4; ++i) {
    pairs.add_base(at(0.03 * i - 0.015), 0.0, 1.0);
    CHECK(pairs.add_robot(at(0.03 * i), 0.0, 0.0, mean) == (i == 4));
  }
  CHECK(mean.base_variance == doctest::Approx(0.25));
  // Weights of the five robot samples: 1/8, three of 1/4, 1/8.
  CHECK(mean.robot_share == doctest::Approx(3.0 / 16.0 + 2.0 / 64.0));
}

TEST_CASE("the robot's air reaches back five seconds, and no further") {
  RobotAir air;
  for (int i = 0; i <= 1000; ++i) air.add(at(0.01 * i), i, 0.0);
  CHECK(air.remembers(at(5.0)));
  CHECK_FALSE(air.remembers(at(4.0)));
  CHECK(air.at(at(7.005)).log_pa == doctest::Approx(700.5));
  CHECK(air.at(at(99.0)).log_pa == doctest::Approx(1000.0));
  CHECK_FALSE(air.reaches(at(10.1)));
}

}  // namespace isobar::test::test_pressure_pairs
