// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <limits>

#include "core/prior/dead_reckoning.hpp"
#include "tests/core/prior/simulated_robot.hpp"

namespace isobar::test::test_dead_reckoning {

namespace {
std::int64_t at(double t) { return static_cast<std::int64_t>(t * 1e9); }
WheelSample wheel(double t, double v) { return {at(t), v, 0.0, 0.0}; }
}  // namespace

TEST_CASE("the displacement is the integral of the speed, also where samples come late") {
  WheelOdometer odometer{DeadReckoningConfig{}};
  double sum = 0.0;
  for (int i = 0; i <= 500; ++i) {
    const double t = i * 0.02;
    odometer.add(wheel(t, 0.5 * t));
    // Queried 15 ms after the sample: extrapolated, and corrected at the next call.
    sum += odometer.take_displacement(at(t + 0.015)).x();
  }
  CHECK(sum == doctest::Approx(0.25 * 10.0 * 10.0 + 5.0 * 0.015).epsilon(1e-6));
}

TEST_CASE("silent wheels are lost, and the gap adds no displacement") {
  WheelOdometer odometer{DeadReckoningConfig{}};
  odometer.add(wheel(0.0, 1.0));
  odometer.add(wheel(0.1, 1.0));
  CHECK(odometer.take_displacement(at(0.1)).x() == doctest::Approx(0.1));
  CHECK(odometer.valid(at(0.59)));
  CHECK_FALSE(odometer.valid(at(0.61)));
  CHECK(odometer.take_displacement(at(3.0)).x() == 0.0);
  odometer.add(wheel(5.0, 1.0));
  CHECK(odometer.take_displacement(at(5.0)).x() == doctest::Approx(0.0));
  CHECK(odometer.take_displacement(at(5.1)).x() == doctest::Approx(0.1));
}

TEST_CASE("absurd speeds are refused; a jump is refused until the fifth consecutive sample confirms it") {
  WheelOdometer odometer{DeadReckoningConfig{}};
  CHECK(odometer.add(wheel(0.0, std::numeric_limits<double>::quiet_NaN())) == WheelStatus::kBadValue);
  CHECK(odometer.add(wheel(0.0, 0.5)) == WheelStatus::kAccepted);
  CHECK(odometer.add(wheel(0.0, 0.5)) == WheelStatus::kBadTime);
  CHECK(odometer.add(wheel(0.02, 500.0)) == WheelStatus::kBadValue);
  CHECK(odometer.add(wheel(0.04, 5.0)) == WheelStatus::kBadValue);
  CHECK(odometer.add(wheel(0.06, 0.5)) == WheelStatus::kAccepted);
  int refused = 0;
  for (int i = 0; i < 10; ++i) {
    refused += odometer.add(wheel(0.08 + 0.02 * i, 5.0)) == WheelStatus::kBadValue ? 1 : 0;
  }
  CHECK(refused == 4);
}

TEST_CASE("dead reckoning follows stairs: path length and height from wheels and attitude") {
  SimulatedRobot robot;
  Drive drive;
  drive.speed = 0.5;
  drive.radius_m = 20.0;
  drive.height = [](double s) { return -travelled(s, 0.577, 6.0, 12.0, 1.0); };
  robot.motion = drive;
  robot.duration_s = 45.0;
  robot.errors = SensorErrors{};
  robot.errors.wheel_scale = robot.errors.stairs_slip = robot.errors.misalignment = robot.errors.accel_bias =
      0.0;
  robot.errors.gyro_bias = 0.0;
  const auto comparisons = run(robot, config_for(robot), 7);
  const auto& end = comparisons.back();
  const Eigen::Vector3d error = end.prior.T_odom_base.translation() - end.truth.p;
  // 21 m: a yaw drift of 0.3 deg, of which half counts, is 6 cm; attitude errors of 0.1 deg on the climb are
  // 1 to 2 cm.
  CHECK(error.head<2>().norm() < 0.15);
  CHECK(std::abs(error.z()) < 0.06);
  CHECK(end.truth.p.z() < -3.0);
}

}  // namespace isobar::test::test_dead_reckoning
