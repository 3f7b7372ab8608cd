// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "tests/core/registration/registration_run.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_registration {

TEST_CASE("3-, 4- and 6-DOF follow a drive around a room; dead reckoning alone is off by 20 cm") {
  for (const Method method : {Method::k3Dof, Method::k4Dof, Method::k6Dof}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(furnished_room(), circle, drifting(circle), method);
    int registered = 0;
    for (int i = 0; i < 80; ++i) {
      registered += run.step().mode == PoseMode::kRegistered ? 1 : 0;
    }
    CHECK(registered >= 78);
    // Noise of 1.5 cm a point averages out; the drift of a growing map is left.
    CHECK(run.position_error().norm() < 0.02);
    CHECK(run.rotation_error_deg() < 0.3);
    CHECK(run.pose().effective_method == method);
    CHECK(run.pose().overlap > 0.8);
    CHECK_FALSE(run.pose().degenerate);
    // 8 s of 0.3 deg/s and 4 % of 1.5 m: the error of the prior alone is much larger.
    const Eigen::Isometry3d odom = drifting(circle)(run.pose().stamp_ns).T_odom_base;
    CHECK((odom.translation() - circle(run.pose().stamp_ns).translation()).norm() > 0.05);
  }
}

TEST_CASE("the map starts at x = y = yaw = 0 and the altimeter's height, for any pose in odom") {
  const Motion tilted = [](std::int64_t stamp_ns) {
    Eigen::Isometry3d T = circle(stamp_ns);
    T.linear() = T.linear() * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
    return T;
  };
  const MakePrior elsewhere = [&](std::int64_t stamp_ns) {
    Prior prior = drifting(tilted)(stamp_ns);
    prior.T_odom_base = Eigen::Translation3d(7.0, 8.0, 9.0) *
                        Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) * prior.T_odom_base;
    prior.height_m = 0.25;
    return prior;
  };
  RegistrationRun run(furnished_room(), tilted, elsewhere, Method::k3Dof);
  const Eigen::Isometry3d T = run.step().T_map_base;
  CHECK(T.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 0.25), 1e-9));
  CHECK(std::atan2(T.linear()(1, 0), T.linear()(0, 0)) == doctest::Approx(0.0).epsilon(1e-9));
  CHECK(std::asin(-T.linear()(2, 0)) == doctest::Approx(0.1).epsilon(1e-6));
  // T_map_base = T_map_odom * T_odom_base.
  const Eigen::Isometry3d odom = elsewhere(run.pose().stamp_ns).T_odom_base;
  CHECK((run.pose().T_map_odom * odom).isApprox(T, 1e-9));
}

TEST_CASE("3-DOF has bit for bit the height from pressure, and roll and pitch from gravity") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  for (int i = 0; i < 20; ++i) {
    run.step();
    const Prior prior = drifting(circle)(run.pose().stamp_ns);
    CHECK(run.pose().T_map_base.translation().z() == doctest::Approx(prior.height_m).epsilon(1e-12));
    const Eigen::Vector3d up = run.pose().T_map_base.linear().row(2);
    CHECK((up - prior.T_odom_base.linear().row(2).transpose()).norm() < 1e-9);
  }
}

TEST_CASE("a registration that is built anew in mid-drive goes on in the same map, without a jump") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(30);
  for (const Method method : {Method::k3Dof, Method::k6Dof, Method::k4Dof}) {
    RegistrationConfig config;
    config.max_iterations = 20;
    config.min_range_m = 0.7;
    const Eigen::Vector3d error_before = run.position_error();
    run.rebuild(config, method);
    CHECK(run.step().mode == PoseMode::kRegistered);
    // One scan's error: noise of 1.5 cm a point averages out.
    CHECK((run.position_error() - error_before).norm() < 0.01);
    run.steps(10);
    CHECK(run.pose().method == method);
    CHECK(run.position_error().norm() < 0.02);
  }
}

TEST_CASE("in a corridor without features the wheels bridge its axis, and the pose is marked degenerate") {
  RegistrationRun run(bare_corridor(), along_x, drifting(along_x), Method::k3Dof);
  run.steps(80);
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.pose().degenerate);
  const Direction& weakest = run.pose().localisability.directions[0];
  CHECK(run.pose().localisability.weak_count() == 1);
  CHECK(std::abs(weakest.axis[0]) > 0.95F);
  CHECK(weakest.holder == Holder::kWheels);
  // 5.6 m with 4 % of scale error are 0.22 m: along the axis the wheels are the only source.
  CHECK(run.position_error().x() == doctest::Approx(0.224).epsilon(0.25).scale(0.0));
  CHECK(std::abs(run.position_error().y()) < 0.02);
  CHECK(run.rotation_error_deg() < 0.3);
  CHECK(std::sqrt(run.pose().covariance(0, 0)) > 0.224 / 3.0);
}

TEST_CASE("in a corridor without features the covariance is large along it and small across") {
  // Wheels that run straight: a drift of their yaw would look like a lidar that is turned.
  const MakePrior straight = [](std::int64_t stamp_ns) {
    Prior prior = drifting(along_x)(stamp_ns);
    prior.T_odom_base.linear().setIdentity();
    return prior;
  };
  RegistrationRun run(bare_corridor(), along_x, straight, Method::k3Dof);
  run.steps(80);
  CHECK(run.pose().covariance(0, 0) > 4.0 * run.pose().covariance(1, 1));
}

TEST_CASE("method odometry ignores the scan") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::kOdometry);
  run.steps(40);
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  const Eigen::Isometry3d first = drifting(circle)(kRunStartNs + kRunScanNs).T_odom_base;
  const Eigen::Isometry3d now = drifting(circle)(run.pose().stamp_ns).T_odom_base;
  const Eigen::Vector3d expected =
      Eigen::AngleAxisd(-0.0005, Eigen::Vector3d::UnitZ()) * (now.translation() - first.translation());
  CHECK((run.pose().T_map_base.translation() - expected).head<2>().norm() < 1e-6);
}

TEST_CASE("registering a scan allocates nothing") {
  for (const Method method : {Method::k3Dof, Method::k6Dof}) {
    RegistrationRun run(furnished_room(), circle, drifting(circle), method);
    run.steps(10);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.allocations() == 0);
  }
  CHECK(allocation_count() > 0);  // the counter works
}

TEST_CASE("the adaptive method finds the scale of the wheels' distance") {
  RegistrationRun straight(furnished_room(), along_x, drifting(along_x), Method::kAdaptive);
  straight.steps(70);
  CHECK(straight.pose().mount.wheel_distance.scale == doctest::Approx(1.0 / 1.04).epsilon(0.02));
  CHECK(straight.pose().mount.wheel_distance.sigma > 0.0);
}

}  // namespace isobar::test::test_registration
