// SPDX-License-Identifier: BSD-3-Clause
// Covariance of the poses of a whole registration, in every method.
#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_registration_covariance {

namespace {

// Not the adaptive method, which begins its map after a look at rest, away from the truth's first pose.
constexpr Method kMethods[] = {Method::k3Dof,         Method::k4Dof,         Method::k6Dof,
                               Method::k4DofAltitude, Method::k6DofAltitude, Method::kOdometry};

double sd_m(const PoseEstimate& pose, int axis) { return std::sqrt(pose.covariance(axis, axis)); }

void check_valid(const PoseEstimate& pose) {
  CHECK(pose.covariance.allFinite());
  CHECK((pose.covariance - pose.covariance.transpose()).norm() < 1e-12 + 1e-9 * pose.covariance.norm());
  CHECK(Eigen::SelfAdjointEigenSolver<Matrix6d>(pose.covariance).eigenvalues().minCoeff() > 0.0);
}

}  // namespace

TEST_CASE("the covariance of the fixed methods is positive definite and holds the errors") {
  for (const Method method : kMethods) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(furnished_room(), circle, drifting(circle), method);
    int inside = 0;
    constexpr int kScans = 120;
    for (int i = 0; i < kScans; ++i) {
      const PoseEstimate& pose = run.step();
      if (pose.covariance.isZero(0.0)) continue;  // before the map begins
      check_valid(pose);
      const Eigen::Vector3d error = run.position_error();
      bool all = true;
      for (int axis = 0; axis < 3; ++axis)
        all = all && std::abs(error[axis]) < 3.0 * sd_m(pose, axis) + 0.005;
      inside += all ? 1 : 0;
    }
    // Wheels of 4 % of scale error, where one knows of 1.5: odometry is outside at times.
    CHECK(inside > (method == Method::kOdometry ? kScans / 3 : kScans * 2 / 3));
  }
}

TEST_CASE(
    "on known ground the covariance stays; without scans it grows with the way until one registers again") {
  for (const Method method : {Method::kAdaptive, Method::k3Dof, Method::k4Dof, Method::k6Dof}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(furnished_room(), circle, drifting(circle), method);
    run.steps(180);  // once around
    const double once = sd_m(run.pose(), 0);
    run.steps(160);
    CHECK(sd_m(run.pose(), 0) < 2.0 * once);
    double last = sd_m(run.pose(), 0);
    PoseEstimate between;
    for (int i = 0; i < 5; ++i) {
      for (int k = 0; k < 10; ++k) run.step(false);
      REQUIRE(run.registration().propagate(between));
      check_valid(between);
      CHECK(sd_m(between, 0) > last);
      last = sd_m(between, 0);
    }
    CHECK(last > 0.015);  // 3 m of way
    run.steps(5);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(sd_m(run.pose(), 0) < last);
  }
}

TEST_CASE("without scans and wheels the position is lost within seconds, and said to be") {
  RegistrationRun run(furnished_room(), circle, without_wheels(drifting(circle)), Method::k3Dof);
  run.steps(40);
  for (int i = 0; i < 100; ++i) run.step(false);
  PoseEstimate between;
  REQUIRE(run.registration().propagate(between));
  CHECK(sd_m(between, 0) > 1.0);
}

}  // namespace isobar::test::test_registration_covariance
