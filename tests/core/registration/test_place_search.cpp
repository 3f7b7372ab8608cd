// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_place_search {
namespace {

constexpr int kMapSteps = 40;
// All hypotheses are tried twice, four a scan.
constexpr int kMostSearchSteps = 30;

KnownPlace place_at(const Eigen::Isometry3d& T_map_base) {
  KnownPlace place;
  place.T_map_base = T_map_base;
  return place;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, double x_m, double y_m, double yaw_deg) {
  Eigen::Isometry3d T = pose;
  T.linear() = rotation_about_z(yaw_deg * kRadPerDeg) * pose.linear();
  T.translation().head<2>() += Eigen::Vector2d(x_m, y_m);
  return T;
}

/// A room with another shape and other obstacles.
World another_room() {
  World world;
  world.add_box({-3.1, -2.2, 0.0}, {4.4, 6.3, 2.6});
  world.add_box({0.9, 2.0, 0.0}, {1.7, 4.1, 1.4});
  world.add_box({-2.2, 3.0, 0.0}, {-1.0, 3.6, 2.2});
  return world;
}

/// Of the room, only the floor is left.
World hall() {
  World world;
  world.add_box({-30.0, -25.0, 0.0}, {35.0, 28.0, 9.0});
  return world;
}

}  // namespace

TEST_CASE("a continued run finds its place: where it was, pushed aside, and turned on the spot") {
  struct Error {
    double x_m, y_m, yaw_deg;
  };
  for (const Error& e :
       {Error{0, 0, 0}, Error{0.8, 0.4, 0}, Error{-0.3, 0.9, 25}, Error{0.1, 0, 170}, Error{0, 0.2, -95}}) {
    CAPTURE(e.x_m);
    CAPTURE(e.yaw_deg);
    RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
    run.steps(kMapSteps);
    const std::size_t cells = run.map().cell_count();
    run.restart_at(place_at(moved(run.pose().T_map_base, e.x_m, e.y_m, e.yaw_deg)));
    int searched = 0;
    while (run.registration().searching() && searched < kMostSearchSteps) {
      CHECK(run.step().mode != PoseMode::kPriorOnly);
      if (run.registration().searching()) CHECK(run.map().cell_count() == cells);
      ++searched;
    }
    CHECK(run.pose().session == 1);
    CHECK(searched < kMostSearchSteps);
    run.steps(3);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    // As without the restart: the drift of a growing map.
    CHECK(run.position_error().norm() < 0.04);
    CHECK(run.rotation_error_deg() < 0.5);
  }
}

TEST_CASE("in another place a new frame begins at the origin, and the old map stays as it was") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(kMapSteps);
  const std::size_t cells = run.map().cell_count();
  KnownPlace place = place_at(run.pose().T_map_base);
  place.overlap = run.pose().overlap;
  place.residual_rms_m = run.pose().residual_rms_m;
  run.restart_at(place);
  run.enter(another_room());
  for (int i = 0; i < kMostSearchSteps && run.pose().session == 1; ++i) run.step();
  CHECK(run.pose().session == 2);
  CHECK(run.map().cell_count() == cells);
  run.step();
  // The robot drives on at 0.6 m/s during the first scans of the new frame.
  CHECK(run.pose().T_map_base.translation().head<2>().norm() < 0.2);
  CHECK_FALSE(run.registration().searching());
}

TEST_CASE(
    "a robot that stood when its process was killed keeps its frame, whatever its surroundings became") {
  for (const bool stood : {true, false}) {
    CAPTURE(stood);
    RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
    run.steps(kMapSteps);
    KnownPlace place = place_at(run.pose().T_map_base);
    place.stamp_ns = run.pose().stamp_ns - 1'000'000'000;
    place.overlap = run.pose().overlap;
    place.residual_rms_m = run.pose().residual_rms_m;
    if (!stood) place.v_map_m_s = {5.0, 0.0, 0.0};
    run.restart_at(place);
    run.enter(hall());
    PoseMode first_known = PoseMode::kInitializing;
    for (int i = 0; i < kMostSearchSteps && first_known == PoseMode::kInitializing; ++i) {
      first_known = run.step().mode;
      if (run.pose().session != 1) break;
    }
    CHECK(run.pose().session == (stood ? 1U : 2U));
    if (!stood) continue;
    // No scan has confirmed it: the pose is the prior's, and says how well it is known.
    CHECK(first_known == PoseMode::kPriorOnly);
    CHECK(run.pose().covariance(0, 0) > 0.01);
    CHECK(run.pose().covariance(0, 0) < 1.0);
  }
}

TEST_CASE("between places that look alike the expected one is taken") {
  // A corridor without features: the scans say nothing about the way along it.
  World corridor;
  corridor.add_box({-60.0, -1.2, 0.0}, {60.0, 1.2, 2.6});
  RegistrationRun run(corridor, along_x, drifting(along_x), Method::k3Dof);
  run.steps(kMapSteps);
  KnownPlace place = place_at(run.pose().T_map_base);
  place.stamp_ns = run.pose().stamp_ns;
  place.overlap = run.pose().overlap;
  place.residual_rms_m = run.pose().residual_rms_m;
  const double x_m = run.pose().T_map_base.translation().x();
  run.restart_at(place);
  int steps = 0;
  while (run.registration().searching() && steps < kMostSearchSteps) {
    run.step();
    ++steps;
  }
  CHECK(run.pose().session == 1);
  CHECK(steps < kMostSearchSteps);
  // 0.8 m/s, 0.1 s a scan; dead reckoning is off by 4 %.
  CHECK(std::abs(run.pose().T_map_base.translation().x() - x_m - 0.08 * steps) < 0.15);
}

TEST_CASE("a new frame on command begins with the next number") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(10);
  run.registration().begin_new_frame();
  run.step();
  CHECK(run.pose().session == 2);
  CHECK(run.pose().mode == PoseMode::kInitializing);
  CHECK(run.pose().T_map_base.translation().head<2>().norm() < 1e-9);
}

}  // namespace isobar::test::test_place_search
