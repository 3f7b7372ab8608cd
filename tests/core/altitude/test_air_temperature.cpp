// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

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
    tracker.add(0, at(t), t < 100.0 ? 26.0 : 14.0);
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
    tracker.add(0, at(t), t > 200.0 && t < 600.0 ? -10.0 : 22.0);
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
    if (t < 100.0) tracker.add(0, at(t), 5.0);
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

}  // namespace isobar::test::test_air_temperature
