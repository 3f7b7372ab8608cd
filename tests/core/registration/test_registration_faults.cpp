// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "core/stamp.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_registration_faults {

TEST_CASE("without any barometer 3-DOF runs as 4-DOF, reports it, and still keeps the height") {
  const MakePrior blind = [](std::int64_t stamp_ns) {
    Prior prior = drifting(circle)(stamp_ns);
    prior.height_m = 77.0;
    prior.height_source = HeightSource::kNone;
    return prior;
  };
  RegistrationRun run(furnished_room(), circle, blind, Method::k3Dof);
  run.steps(40);
  CHECK(run.pose().method == Method::k3Dof);
  CHECK(run.pose().effective_method == Method::k4Dof);
  CHECK(run.position_error().norm() < 0.02);
}

TEST_CASE("without wheels the velocity of the registrations replaces dead reckoning") {
  for (const Method method : {Method::k3Dof, Method::k6Dof}) {
    RegistrationRun run(furnished_room(), circle, without_wheels(drifting(circle)), method);
    run.steps(80);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.position_error().norm() < 0.03);
  }
}

TEST_CASE("without wheels a run that begins in motion finds its speed") {
  const Motion fast = [](std::int64_t stamp_ns) {
    const double x_m = -4.0 + 3.0 * 1e-9 * static_cast<double>(stamp_ns - kRunStartNs);
    return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0.5, 0.7));
  };
  const MakePrior moving = [&](std::int64_t stamp_ns) { return perfect_prior(fast, stamp_ns); };
  for (const Method method : {Method::k4Dof, Method::k6Dof, Method::kAdaptive}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(furnished_room(), fast, without_wheels(moving), method);
    run.steps(6);
    const Eigen::Vector3d before = run.position_error();
    run.steps(10);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK((run.position_error() - before).norm() <
          0.1);  // on 3 m; 1.3 m where the robot is believed to stand
  }
}

TEST_CASE(
    "after five seconds without lidar, bridged by the prior, the next scans register to the map again") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(30);
  for (int i = 0; i < 50; ++i) {
    run.step(false);
    PoseEstimate between;
    REQUIRE(run.registration().propagate(between));
    CHECK(between.mode == PoseMode::kPriorOnly);
  }
  PoseEstimate bridged;
  REQUIRE(run.registration().propagate(bridged));
  const Eigen::Vector3d truth = circle(bridged.stamp_ns).translation() - circle(kRunStartNs).translation();
  // 3 m of travel with 4 % of scale error and 1.5 degrees of drift.
  CHECK((bridged.T_map_base.translation() - truth).norm() < 0.3);
  CHECK(bridged.covariance(0, 0) > run.pose().covariance(0, 0));
  run.steps(5);
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.03);
}

TEST_CASE("a scan of another place is rejected and gets the prior's pose; the following scans register") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(20);
  World elsewhere;
  elsewhere.add_box({-30.0, -25.0, -10.0}, {27.0, 33.0, 14.0});
  run.enter(elsewhere);
  run.step();
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  CHECK(run.position_error().norm() < 0.03);
  run.enter(furnished_room());
  run.steps(3);
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.02);
}

TEST_CASE("an unmapped place is entered with the prior and mapped") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(20);
  World hall;
  hall.add_box({-30.0, -25.0, 0.0}, {27.0, 33.0, 8.0});
  run.enter(hall);
  int registered = 0;
  for (int i = 0; i < 30; ++i) {
    registered += run.step().mode == PoseMode::kRegistered ? 1 : 0;
  }
  CHECK(registered > 20);
  CHECK(run.position_error().norm() < 0.15);
}

TEST_CASE("empty scans and scans out of order get the prior's pose") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(10);
  run.scan().point_count = 0;
  run.register_scan();
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  CHECK(run.pose().T_map_base.matrix().allFinite());
  run.scan().stamp_ns -= 3 * kRunScanNs;
  run.scan().end_stamp_ns -= 3 * kRunScanNs;
  run.register_scan();
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  run.steps(5);
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.02);
}

TEST_CASE(
    "sensor clocks that start over with a new frame leave nothing of the adaptive method waiting for the old "
    "ones") {
  const MakePrior zone = [](std::int64_t stamp_ns) {
    Prior prior = drifting(circle)(stamp_ns);
    const double t = seconds_between(kRunStartNs, stamp_ns);
    prior.altimeter_m = t > 4.0 ? 0.2 : 0.0;  // after the map has begun
    prior.altimeter_variance_m2 = 1e-4;
    prior.altimeter_count = static_cast<std::uint32_t>(t * 30.0);
    return prior;
  };
  RegistrationRun run(furnished_room(), circle, zone, Method::kAdaptive);
  run.steps(120);
  const double bias_m = run.pose().altimeter.bias_m;
  CHECK(bias_m == doctest::Approx(0.2).epsilon(0.25));
  run.start_over();
  run.steps(30);
  CHECK(std::abs(run.pose().altimeter.bias_m) < 0.02);
  run.steps(90);
  CHECK(run.pose().altimeter.bias_m == doctest::Approx(bias_m).epsilon(0.05));
}

TEST_CASE("before the first prior no scan is registered and no pose is propagated") {
  Registration registration(RegistrationConfig{}, Method::k3Dof, run_lidar_mount());
  auto scan = std::make_unique<Scan>();
  std::mt19937 random(1);
  scan_world(furnished_room(), circle, run_lidar_mount(), kRunStartNs, 0.0, random, *scan);
  CHECK_FALSE(registration.ready(*scan));
  auto out = std::make_unique<RegisteredScan>();
  registration.register_scan(*scan, MapSnapshot(), *out);
  CHECK(out->pose.mode == PoseMode::kInitializing);
  CHECK(out->point_count == 0);
  PoseEstimate pose;
  CHECK_FALSE(registration.propagate(pose));
}

}  // namespace isobar::test::test_registration_faults
