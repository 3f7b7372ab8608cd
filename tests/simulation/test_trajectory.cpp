// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/trajectory.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "simulation/route.hpp"
#include "simulation/stairwell.hpp"

namespace isobar::test::test_trajectory {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

/// A route with a corner, a staircase and a stop.
Trajectory make_drive() {
  StairSizes sizes;
  sizes.steps = 6;
  const Stairwell well({0.0, 0.0}, {-1.0, 0.0}, 1.0, sizes);
  Route route({4.0, 3.0}, 0.0, -1.570796326794897);
  route.wait(1.0);
  std::vector<Waypoint> way{{{4.0, 0.0}}, {{0.0, 0.0}}};
  well.route_up(way, 0.0, 0.35);
  route.drive(way);
  route.turn(2.5);
  route.ride(-3.0, 1.0, 0.8);
  std::vector<RawPose> raw = route.samples();
  add_shaking(raw, route.labels(), Random(5));
  return Trajectory(raw);
}

}  // namespace

TEST_CASE("velocity, acceleration and both angular rates are the derivatives of the pose") {
  const Trajectory drive = make_drive();
  // Central differences: their error, h^2/6 times the third derivative (below 100 m/s^3), is far below the
  // tolerances.
  constexpr double kH = 2e-4;
  double largest_a = 0.0;
  for (double t = 1.0; t < drive.duration_s() - 1.0; t += 0.0377) {
    const MotionState before = drive.at(t - kH);
    const MotionState now = drive.at(t);
    const MotionState after = drive.at(t + kH);
    CHECK((now.v_world - (after.p_world - before.p_world) / (2.0 * kH)).norm() < 1e-5);
    CHECK((now.a_world - (after.v_world - before.v_world) / (2.0 * kH)).norm() < 1e-3);
    const Eigen::AngleAxisd turned(before.q_world_base.conjugate() * after.q_world_base);
    const Vector3d w = turned.angle() * turned.axis() / (2.0 * kH);
    CHECK((now.w_base - w).norm() < 1e-5);
    CHECK((now.wdot_base - (after.w_base - before.w_base) / (2.0 * kH)).norm() < 1e-3);
    largest_a = std::max(largest_a, now.a_world.norm());
  }
  CHECK(largest_a > 0.3);  // the robot does accelerate
}

TEST_CASE("position and attitude are smooth: the acceleration is continuous") {
  const Trajectory drive = make_drive();
  double largest_step = 0.0;
  double largest_turn_step = 0.0;
  for (double t = 0.5; t < drive.duration_s() - 0.5; t += 1e-3) {
    largest_step = std::max(largest_step, (drive.at(t + 1e-6).a_world - drive.at(t - 1e-6).a_world).norm());
    largest_turn_step =
        std::max(largest_turn_step, (drive.at(t + 1e-6).wdot_base - drive.at(t - 1e-6).wdot_base).norm());
  }
  CHECK(largest_step < 1e-3);  // jerk stays below 500 m/s^3
  CHECK(largest_turn_step < 1e-3);
}

TEST_CASE("the robot faces its direction of travel, on the flat and on stairs") {
  const Trajectory drive = make_drive();
  double worst_side = 0.0;
  double steepest = 0.0;
  for (double t = 1.5; t < drive.duration_s() - 12.0; t += 0.05) {
    const MotionState state = drive.at(t);
    if (state.v_world.norm() < 0.2) continue;
    const Vector3d v_base = state.q_world_base.conjugate() * state.v_world;
    worst_side = std::max(worst_side, std::abs(v_base.y()) / v_base.x());
    steepest = std::max(steepest, std::asin(std::abs(state.q_world_base.toRotationMatrix()(2, 0))));
  }
  CHECK(worst_side < 0.12);  // smoothing of corners and vibration of the heading: some degrees
  // 0.17 m rise on 0.29 m going is 30.4 degrees.
  CHECK(steepest > 0.50);
  CHECK(steepest < 0.62);
}

TEST_CASE("an elevator ride respects its limits of speed and acceleration and reaches the target height") {
  Route route({0.0, 0.0}, 10.0, 0.0);
  route.wait(1.0);
  route.ride(-7.3, 1.0, 0.8);
  route.wait(2.0);
  const Trajectory ride(route.samples());
  double speed = 0.0;
  double acceleration = 0.0;
  for (double t = 0.0; t < ride.duration_s(); t += 0.01) {
    speed = std::max(speed, -ride.at(t).v_world.z());
    acceleration = std::max(acceleration, std::abs(ride.at(t).a_world.z()));
  }
  CHECK(ride.at(ride.duration_s()).p_world.z() == doctest::Approx(2.7));
  CHECK(speed == doctest::Approx(1.0).epsilon(0.001));
  CHECK(acceleration == doctest::Approx(0.8).epsilon(0.03));  // the spline flattens the peak
}

}  // namespace isobar::test::test_trajectory
