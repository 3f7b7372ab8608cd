// SPDX-License-Identifier: BSD-3-Clause
// The height of the whole estimator on simulated motion with realistic errors.
#include <doctest/doctest.h>

#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_height {

namespace {

SimulatedRobot flat_robot(double duration_s) {
  SimulatedRobot robot;
  Drive drive;
  drive.radius_m = 40.0;
  robot.motion = drive;
  robot.duration_s = duration_s;
  return robot;
}

double error_at(const std::vector<Comparison>& comparisons, double t) {
  for (const Comparison& c : comparisons) {
    if (c.t >= t) return c.prior.height_m - c.height_truth_m;
  }
  return 1e9;
}

}  // namespace

TEST_CASE("on flat ground the height error over 5 m of travel has a median below 0.3 percent") {
  double sum = 0.0;
  double nees = 0.0;
  const int seeds = 4;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const auto robot = flat_robot(120.0);
    const Figures figures = figures_of(run(robot, config_for(robot), seed, nullptr, 8));
    sum += figures.z_rpe_median;
    nees += figures.nees;
    // Unobservable warm-up of 1 Pa (8 cm, 1 sigma), a third of it within two minutes.
    CHECK(figures.height_max_m < 0.15);
  }
  CHECK(sum / seeds < 0.003);
  // Consistency (NEES near 1): the variance is neither far too small nor far too large.
  CHECK(nees / seeds < 3.0);
  CHECK(nees / seeds > 0.1);
}

TEST_CASE("stairs are followed with slipping tracks") {
  SimulatedRobot robot;
  Drive drive;
  drive.speed = 0.5;
  drive.radius_m = 30.0;
  drive.height = [](double s) { return -travelled(s, 0.577, 10.0, 17.0, 1.0); };
  robot.motion = drive;
  robot.duration_s = 60.0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    // 4 m down; 5 % of slip and 2 % of scale would be 28 cm.
    CHECK(figures_of(run(robot, config_for(robot), seed, nullptr, 4)).height_max_m < 0.15);
  }
}

TEST_CASE("an elevator is followed without lag, and the robot stays at rest after it") {
  for (const double speed : {1.5, -1.2}) {
    SimulatedRobot robot;
    Drive drive;
    drive.radius_m = 40.0;
    drive.stop_s = 12.0;
    drive.lift = [speed](double t) { return travelled(t, speed, 20.0, 28.0, 1.2); };
    robot.motion = drive;
    robot.duration_s = 45.0;
    robot.errors.turbulence = 0.1;
    robot.errors.warm_up = 0.0;
    PriorCounters counters;
    const auto comparisons = run(robot, config_for(robot), 3, &counters);
    CHECK(counters.moving_ground == 1);
    double before = error_at(comparisons, 19.9);
    double largest = 0.0;
    for (const Comparison& c : comparisons) {
      if (c.t > 20.0 && c.t < 30.0) {
        largest = std::max(largest, std::abs(c.prior.height_m - c.height_truth_m - before));
        CHECK((!c.prior.standing_still || c.t < 21.0 || c.t > 28.0));
      }
    }
    CHECK(largest < 0.08);
    CHECK(std::abs(error_at(comparisons, 44.0) - error_at(comparisons, 34.0)) < 0.03);
    // The wheels did not turn: dead reckoning has no climb.
    CHECK(std::abs(comparisons.back().prior.T_odom_base.translation().z()) < 0.1);
  }
}

TEST_CASE("the pulse of a slamming door is rejected") {
  SimulatedRobot robot = flat_robot(60.0);
  robot.extra_robot_pa = [](double t) { return t > 30.0 && t < 31.5 ? 40.0 : 0.0; };
  PriorCounters counters;
  const auto comparisons = run(robot, config_for(robot), 5, &counters, 2);
  // 40 Pa are 3.4 m.
  CHECK(std::abs(error_at(comparisons, 31.4) - error_at(comparisons, 29.9)) < 0.05);
  CHECK(std::abs(error_at(comparisons, 34.0) - error_at(comparisons, 29.9)) < 0.05);
  CHECK(counters.pressure_gated >= 12);  // 1.5 s at eight heights a second
  CHECK(counters.pressure_steps == 0);
  CHECK(counters.moving_ground == 0);
}

TEST_CASE("a pressure step that is faster than any climb does not move the height") {
  SimulatedRobot robot = flat_robot(60.0);
  robot.extra_robot_pa = [](double t) { return t > 30.0 ? -12.0 : 0.0; };  // 1.02 m up
  PriorCounters counters;
  const auto comparisons = run(robot, config_for(robot), 5, &counters, 2);
  CHECK(counters.pressure_steps == 1);
  CHECK(std::abs(error_at(comparisons, 32.5) - error_at(comparisons, 29.9)) < 0.1);
  CHECK(std::abs(error_at(comparisons, 36.0) - error_at(comparisons, 29.9)) < 0.1);
  CHECK(std::abs(error_at(comparisons, 59.0) - error_at(comparisons, 29.9)) < 0.1);
}

TEST_CASE("the height of a pitching robot is corrected for the lever arm of the pressure port") {
  SimulatedRobot robot;
  robot.p_base_port = {-0.6, 0.0, 0.4};
  robot.wheel_hz = 0.0;  // the wheels would outweigh the pressure
  robot.motion = [](double t) {
    Pose pose;
    // Rocks about base_link's origin: the port moves by 0.3 m up and down, base_link does not.
    const double pitch = t < 5.0 ? 0.0 : 0.25 * (1.0 - std::cos(0.5 * (t - 5.0)));
    pose.q = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
    return pose;
  };
  robot.duration_s = 40.0;
  const auto config = config_for(robot);
  CHECK(figures_of(run(robot, config, 8, nullptr, 2)).height_max_m < 0.09);
  PriorConfig without = config;
  without.p_base_port = robot.T_base_imu.translation();
  CHECK(figures_of(run(robot, without, 8, nullptr, 2)).height_max_m > 0.12);
}

TEST_CASE("a hanging platform gets its height from pressure and acceleration") {
  SimulatedRobot robot;
  robot.wheel_hz = 0.0;
  robot.errors.vibration = 0.1;
  robot.motion = [](double t) {
    Pose pose;
    pose.p.z() = -travelled(t, 0.4, 5.0, 70.0, 3.0);
    return pose;
  };
  robot.duration_s = 80.0;
  const Figures figures = figures_of(run(robot, config_for(robot), 9, nullptr, 4));
  // 26 m down: turbulence and warm-up 5 cm, scale error from self-heating a few millimetres.
  CHECK(figures.height_max_m < 0.15);
}

}  // namespace isobar::test::test_height
