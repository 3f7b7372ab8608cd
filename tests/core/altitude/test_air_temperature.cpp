// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/altitude/air_temperature.hpp"

namespace isobar::test::test_air_temperature {

namespace {
std::int64_t at(double t) { return static_cast<std::int64_t>(t * 1e9); }

AirTemperatureConfig thermometers_are_right() {
  AirTemperatureConfig config;
  config.expected_self_heating_k = 0.0;
  return config;
}
}  // namespace

TEST_CASE("self-heating of both sensors raises the estimate by less than 0.6 K") {
  AirTemperatureTracker tracker(thermometers_are_right());
  for (double t = 0.0; t < 600.0; t += 0.5) {
    const double heat = 1.0 - std::exp(-t / 180.0);
    tracker.add(0, at(t), 20.0 + 6.0 * heat);
    tracker.add(1, at(t), 20.0 + 4.0 * heat);
  }
  // The coldest sensor ends 3.9 K too warm; a time constant of an hour passes a tenth of that.
  CHECK(tracker.temperature_c() > 20.0);
  CHECK(tracker.temperature_c() < 20.6);
}

TEST_CASE("the estimate follows the coldest sensor within minutes, without a jump") {
  AirTemperatureTracker tracker(thermometers_are_right());
  double before = 0.0;
  double largest_step = 0.0;
  for (double t = 0.0; t < 400.0; t += 0.1) {
    // A chip takes half a minute to follow the air.
    tracker.add(0, at(t), t < 100.0 ? 26.0 : 14.0 + 12.0 * std::exp(-(t - 100.0) / 30.0));
    tracker.add(1, at(t), 24.0);
    if (t > 10.0) largest_step = std::max(largest_step, std::abs(tracker.temperature_c() - before));
    before = tracker.temperature_c();
  }
  CHECK(std::abs(tracker.temperature_c() - 14.0) < 0.2);
  // 0.1 K in 0.1 s would be 4 mm of height at 12 m.
  CHECK(largest_step < 0.1);
}

TEST_CASE("after a stay in the cold the estimate is too low by at most the largest self-heating") {
  AirTemperatureTracker tracker(thermometers_are_right());
  for (double t = 0.0; t < 1200.0; t += 0.5) {
    const double out_s = std::clamp(t - 200.0, 0.0, 400.0);
    const double back_s = std::max(0.0, t - 600.0);
    tracker.add(0, at(t), 22.0 - 32.0 * (1.0 - std::exp(-out_s / 60.0)) * std::exp(-back_s / 60.0));
    tracker.add(1, at(t), 22.0);
  }
  CHECK(tracker.temperature_c() > 13.0);
  CHECK(tracker.temperature_c() < 22.5);
}

TEST_CASE("a silent sensor is ignored") {
  AirTemperatureConfig config = thermometers_are_right();
  config.max_self_heating_k = 2.0;
  config.rise_time_s = 60.0;
  AirTemperatureTracker tracker(config);
  for (double t = 0.0; t < 900.0; t += 1.0) {
    if (t < 100.0) tracker.add(0, at(t), 12.0);
    tracker.add(1, at(t), 20.0);
  }
  CHECK(tracker.temperature_c() == doctest::Approx(20.0).epsilon(0.01));
}

TEST_CASE("implausible readings are ignored, and so is every reading with a fixed temperature") {
  AirTemperatureTracker tracker(thermometers_are_right());
  CHECK(tracker.temperature_c() == AirTemperatureConfig{}.fixed_c);
  tracker.add(0, at(0.0), std::numeric_limits<double>::quiet_NaN());
  tracker.add(0, at(0.1), 1e9);
  tracker.add(7, at(0.1), 10.0);
  CHECK(tracker.temperature_c() == AirTemperatureConfig{}.fixed_c);
  tracker.add(0, at(1.0), 10.0);
  tracker.add(0, at(0.5), -50.0);  // back in time
  CHECK(tracker.temperature_c() == doctest::Approx(10.0));
  AirTemperatureConfig fixed;
  fixed.mode = AirTemperatureMode::kFixed;
  fixed.fixed_c = -3.0;
  AirTemperatureTracker constant(fixed);
  constant.add(0, at(0.0), 25.0);
  CHECK(constant.temperature_c() == -3.0);
}

TEST_CASE("the expected self-heating is subtracted from a measured temperature, not from a configured one") {
  AirTemperatureConfig config;
  config.expected_self_heating_k = 0.7;
  AirTemperatureTracker tracker(config);
  CHECK(tracker.temperature_c() == config.fixed_c);
  for (double t = 0.0; t < 30.0; t += 0.1) tracker.add(0, at(t), 18.0);
  CHECK(tracker.temperature_c() == doctest::Approx(17.3));
}

namespace {

/// Readings of a robot (4 K of self-heating) and a base station (0.7 K) in 20 degC for five minutes.
AirTemperatureTracker after_five_minutes(double robot_error_k, double base_error_k, double from_s) {
  AirTemperatureTracker tracker{AirTemperatureConfig{}};
  for (double t = 0.0; t < 300.0; t += 0.25) {
    const double heat = 0.5 - 0.5 * std::exp(-t / 180.0);
    const bool off = t >= from_s;
    tracker.add(0, at(t), 20.0 + 4.0 * (0.5 + heat) + (off ? robot_error_k : 0.0));
    tracker.add(1, at(t + 0.01), 20.7 + (off ? base_error_k : 0.0));
  }
  return tracker;
}

// 1 % of the height.
constexpr double kOnePercentK = 2.93;

}  // namespace

TEST_CASE(
    "a thermometer off by 20 to 60 K, from the start or from a moment on, costs less than 1 % of the "
    "height") {
  for (const double error_k : {-60.0, -40.0, -20.0, 20.0, 40.0, 60.0}) {
    for (const double from_s : {0.0, 100.0}) {
      CAPTURE(error_k);
      CAPTURE(from_s);
      const auto robot = after_five_minutes(error_k, 0.0, from_s);
      const auto base = after_five_minutes(0.0, error_k, from_s);
      CHECK(std::abs(robot.temperature_c() - 20.0) < kOnePercentK);
      CHECK(std::abs(base.temperature_c() - 20.0) < kOnePercentK);
      CHECK(robot.wrong(0));
      CHECK_FALSE(robot.wrong(1));
      CHECK(base.wrong(1));
      CHECK_FALSE(base.wrong(0));
      CHECK(robot.sigma_k() > AirTemperatureConfig{}.sigma_k);
      CHECK(base.sigma_k() > AirTemperatureConfig{}.sigma_k);
    }
  }
  CHECK(after_five_minutes(0.0, 0.0, 0.0).sigma_k() == AirTemperatureConfig{}.sigma_k);
}

TEST_CASE("of a robot at 25 degC and a base station at 0 the robot's air counts, with a doubt of 5 K") {
  AirTemperatureTracker tracker{AirTemperatureConfig{}};
  for (double t = 0.0; t < 60.0; t += 0.25) {
    tracker.add(0, at(t), 25.0);
    tracker.add(1, at(t), 0.0);
  }
  // 25 less 1.5 and 0.5 K of self-heating; sigma hypot(2, 0.2 * 25).
  CHECK(tracker.temperature_c() == doctest::Approx(23.0).epsilon(0.01));
  CHECK(tracker.sigma_k() == doctest::Approx(std::hypot(2.0, 5.0)).epsilon(0.01));
}

TEST_CASE("a base station that cools down in the night outdoors does not take the robot's air with it") {
  AirTemperatureTracker tracker(thermometers_are_right());
  for (double t = 0.0; t < 3600.0; t += 1.0) {
    tracker.add(0, at(t), 21.0);
    tracker.add(1, at(t), 20.0 - 25.0 * t / 3600.0);
  }
  // It follows while the difference could be self-heating: to 11 degC after 22 min, and rises again within the hour.
  CHECK(tracker.temperature_c() > 12.5);
  CHECK_FALSE(tracker.wrong(1));
  CHECK(tracker.sigma_k() > 5.0);
}

TEST_CASE("in the winter, thermometers that agree are believed, whatever is configured") {
  AirTemperatureTracker tracker(thermometers_are_right());
  for (double t = 0.0; t < 60.0; t += 0.25) {
    tracker.add(0, at(t), -15.0);
    tracker.add(1, at(t), -17.0);
  }
  CHECK(tracker.temperature_c() == doctest::Approx(-17.0));
  CHECK(tracker.sigma_k() == AirTemperatureConfig{}.sigma_k);
}

TEST_CASE("a single thermometer at -40 degC is not believed in a heated building") {
  AirTemperatureTracker tracker{AirTemperatureConfig{}};
  for (double t = 0.0; t < 60.0; t += 0.25) tracker.add(0, at(t), -40.0);
  CHECK(tracker.temperature_c() == doctest::Approx(20.0));
  CHECK(tracker.wrong(0));
  CHECK(tracker.sigma_k() > 8.0);
}

TEST_CASE("a thermometer that comes back is used again") {
  AirTemperatureTracker tracker{AirTemperatureConfig{}};
  for (double t = 0.0; t < 400.0; t += 0.25) {
    tracker.add(0, at(t), 22.0);
    tracker.add(1, at(t), t > 100.0 && t < 250.0 ? -40.0 : 20.5);
    if (t == 200.0) CHECK(tracker.wrong(1));
  }
  CHECK_FALSE(tracker.wrong(1));
  CHECK(tracker.temperature_c() == doctest::Approx(20.0).epsilon(0.01));
}

}  // namespace isobar::test::test_air_temperature
