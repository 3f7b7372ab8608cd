// SPDX-License-Identifier: BSD-3-Clause
// The height's source when sensors fail, return or are missing.
#include <doctest/doctest.h>

#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_height_sources {

namespace {

SimulatedRobot robot_for(double duration_s) {
  SimulatedRobot robot;
  Drive drive;
  drive.radius_m = 40.0;
  robot.motion = drive;
  robot.duration_s = duration_s;
  return robot;
}

const Comparison& at_time(const std::vector<Comparison>& comparisons, double t) {
  for (const Comparison& c : comparisons) {
    if (c.t >= t) return c;
  }
  return comparisons.back();
}

double largest_step(const std::vector<Comparison>& comparisons, double from_s) {
  double largest = 0.0;
  for (std::size_t i = 1; i < comparisons.size(); ++i) {
    if (comparisons[i].t < from_s) continue;
    const double step = (comparisons[i].prior.height_m - comparisons[i].height_truth_m) -
                        (comparisons[i - 1].prior.height_m - comparisons[i - 1].height_truth_m);
    largest = std::max(largest, std::abs(step));
  }
  return largest;
}

}  // namespace

TEST_CASE("without a barometer the source is kNone and the height is dead reckoning") {
  SimulatedRobot robot = robot_for(20.0);
  robot.robot_hz = 0.0;
  const auto comparisons = run(robot, config_for(robot), 1, nullptr, 4);
  for (const Comparison& c : comparisons) CHECK(c.prior.height_source == HeightSource::kNone);
  CHECK(std::abs(comparisons.back().prior.height_m) < 0.2);
}

TEST_CASE("a single barometer is reported as such, and its variance grows with the weather") {
  SimulatedRobot robot = robot_for(60.0);
  robot.base_hz = 0.0;
  const auto comparisons = run(robot, config_for(robot), 1, nullptr, 4);
  CHECK(at_time(comparisons, 30.0).prior.height_source == HeightSource::kSingleBarometer);
  const SimulatedRobot with_base = robot_for(60.0);
  const auto pair = run(with_base, config_for(with_base), 1, nullptr, 4);
  CHECK(pair.back().prior.height_source == HeightSource::kDifferential);
  CHECK(comparisons.back().prior.height_variance_m2 > pair.back().prior.height_variance_m2);
  CHECK(std::abs(comparisons.back().prior.height_m) <
        4.0 * std::sqrt(comparisons.back().prior.height_variance_m2));
}

TEST_CASE("the height of a silent barometer is held, its variance grows, and it returns without a jump") {
  SimulatedRobot robot = robot_for(60.0);
  robot.robot_on = [](double t) { return t < 20.0 || t > 40.0; };
  const auto comparisons = run(robot, config_for(robot), 2, nullptr, 2);
  CHECK(at_time(comparisons, 20.3).prior.height_source == HeightSource::kDifferential);
  CHECK(at_time(comparisons, 20.5).prior.height_source == HeightSource::kHeld);
  CHECK(at_time(comparisons, 39.0).prior.height_variance_m2 >
        at_time(comparisons, 21.0).prior.height_variance_m2);
  CHECK(at_time(comparisons, 41.0).prior.height_source == HeightSource::kDifferential);
  CHECK(largest_step(comparisons, 5.0) < 0.03);
  CHECK(figures_of(comparisons).height_max_m < 0.2);
}

TEST_CASE("a base station that fails and returns makes no jump") {
  SimulatedRobot robot = robot_for(120.0);
  robot.errors.weather_pa_s = 0.04;
  robot.base_on = [](double t) { return t < 30.0 || t > 80.0; };
  PriorCounters counters;
  const auto comparisons = run(robot, config_for(robot), 3, &counters, 2);
  CHECK(counters.base_lost == 1);
  CHECK(at_time(comparisons, 60.0).prior.height_source == HeightSource::kSingleBarometer);
  CHECK(at_time(comparisons, 79.0).prior.height_variance_m2 >
        at_time(comparisons, 30.0).prior.height_variance_m2);
  CHECK(at_time(comparisons, 85.0).prior.height_source == HeightSource::kDifferential);
  // 50 s of weather are 17 cm; the standing wheels hold the height better.
  CHECK(largest_step(comparisons, 5.0) < 0.05);
  CHECK(figures_of(comparisons).height_max_m < 0.2);
}

TEST_CASE("a base station that starts late, or is slow and delayed, does not disturb the height") {
  SimulatedRobot late = robot_for(80.0);
  late.base_on = [](double t) { return t > 30.0; };
  const auto comparisons = run(late, config_for(late), 4, nullptr, 2);
  CHECK(at_time(comparisons, 29.0).prior.height_source == HeightSource::kSingleBarometer);
  CHECK(at_time(comparisons, 33.0).prior.height_source == HeightSource::kDifferential);
  CHECK(largest_step(comparisons, 5.0) < 0.03);
  SimulatedRobot slow = robot_for(60.0);
  slow.base_hz = 2.0;
  slow.base_delay_s = 0.6;
  CHECK(figures_of(run(slow, config_for(slow), 4, nullptr, 2)).height_max_m < 0.15);
}

TEST_CASE("silent wheels make the velocity invalid, and the height stays accurate") {
  SimulatedRobot robot = robot_for(60.0);
  robot.wheels_on = [](double t) { return t < 20.0 || t > 35.0; };
  const auto comparisons = run(robot, config_for(robot), 5, nullptr, 2);
  CHECK(at_time(comparisons, 19.0).prior.velocity_valid);
  CHECK_FALSE(at_time(comparisons, 21.0).prior.velocity_valid);
  CHECK(at_time(comparisons, 21.0).prior.v_base_m_s.norm() == 0.0);
  CHECK(at_time(comparisons, 36.0).prior.velocity_valid);
  const double stop = at_time(comparisons, 21.0).prior.T_odom_base.translation().norm();
  CHECK(at_time(comparisons, 34.0).prior.T_odom_base.translation().norm() == doctest::Approx(stop));
  CHECK(figures_of(comparisons).height_max_m < 0.3);
}

TEST_CASE("a gap of the IMU is bridged, and the variance covers it") {
  SimulatedRobot robot = robot_for(60.0);
  robot.imu_on = [](double t) { return t < 30.0 || t > 34.0; };
  PriorCounters counters;
  const auto comparisons = run(robot, config_for(robot), 6, &counters);
  CHECK(counters.imu_gaps == 1);
  CHECK(at_time(comparisons, 34.01).prior.height_variance_m2 >
        at_time(comparisons, 29.9).prior.height_variance_m2);
  CHECK(at_time(comparisons, 34.01).prior.roll_pitch_variance_rad2 >
        at_time(comparisons, 29.9).prior.roll_pitch_variance_rad2);
  // The wheels keep measuring during the gap, so that its 4 s at 0.6 m/s are not lost.
  const double moved = (at_time(comparisons, 34.01).prior.T_odom_base.translation() -
                        at_time(comparisons, 29.9).prior.T_odom_base.translation())
                           .norm();
  CHECK(moved == doctest::Approx(2.46).epsilon(0.08));
  const Comparison& end = comparisons.back();
  CHECK(std::abs(end.roll_error_rad) < 0.015);
  CHECK(std::abs(end.pitch_error_rad) < 0.015);
  CHECK(figures_of(comparisons).height_max_m < 0.25);
}

}  // namespace isobar::test::test_height_sources
