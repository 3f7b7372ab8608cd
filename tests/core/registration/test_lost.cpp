// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>

#include "core/geometry.hpp"
#include "core/stamp.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_lost {

namespace {

double time_s(std::int64_t stamp_ns) { return seconds_between(kRunStartNs, stamp_ns); }

/// The circle, and a gyro that from 3 s on turns against the scans for a while.
constexpr double kFirstS = 3.0;
double false_turn_rad(std::int64_t stamp_ns, double for_s) {
  constexpr double kRateRadS = 6.0 * kRadPerDeg;
  return kRateRadS * std::clamp(time_s(stamp_ns) - kFirstS, 0.0, for_s);
}

MakePrior gyro_against_scans(double for_s) {
  return [for_s](std::int64_t stamp_ns) {
    Prior prior = drifting(circle)(stamp_ns);
    prior.T_odom_base.linear() =
        rotation_about_z(false_turn_rad(stamp_ns, for_s)) * prior.T_odom_base.linear();
    return prior;
  };
}

}  // namespace

TEST_CASE(
    "scans that turn against the gyro: lost within 1.5 s, and said in mode, covariance and for the map") {
  for (const Method method : {Method::k3Dof, Method::k4Dof, Method::k6Dof, Method::kAdaptive}) {
    CAPTURE(static_cast<int>(method));
    RegistrationRun run(furnished_room(), circle, gyro_against_scans(100.0), method);
    double lost_s = 0.0;
    for (int i = 0; i < 60 && lost_s == 0.0; ++i) {
      if (run.step().lost != LostReason::kNone) lost_s = time_s(run.pose().stamp_ns);
    }
    CHECK(lost_s > kFirstS);
    CHECK(lost_s < kFirstS + 1.5);
    const PoseEstimate first = run.pose();
    CHECK(first.lost == LostReason::kTurn);
    CHECK(first.lost_since_ns == first.stamp_ns);
    CHECK(first.mode == PoseMode::kPriorOnly);
    CHECK_FALSE(first.for_map);
    CHECK(first.covariance(0, 0) > 0.03);
    // Elsewhere nothing matches: that stays said, with a covariance that grows.
    World elsewhere;
    elsewhere.add_box({-30.0, -25.0, -10.0}, {27.0, 33.0, 14.0});
    run.enter(elsewhere);
    run.steps(20);
    CHECK(run.pose().lost == LostReason::kTurn);
    CHECK(run.pose().lost_since_ns == first.lost_since_ns);
    CHECK(run.pose().covariance(0, 0) > first.covariance(0, 0));
    PoseEstimate between;
    REQUIRE(run.registration().propagate(between));
    CHECK(between.lost == LostReason::kTurn);
    CHECK(between.mode == PoseMode::kPriorOnly);
    CHECK_FALSE(run.registration().searching());
  }
}

TEST_CASE("a robot that was lost finds its place again, and registers there") {
  RegistrationRun run(furnished_room(), circle, gyro_against_scans(1.2), Method::k4Dof);
  bool was_lost = false;
  for (int i = 0; i < 90; ++i) was_lost |= run.step().lost != LostReason::kNone;
  CHECK(was_lost);
  CHECK(run.pose().lost == LostReason::kNone);
  CHECK(run.pose().lost_since_ns == 0);
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.pose().for_map);
  CHECK(run.position_error().norm() < 0.05);
  CHECK(run.rotation_error_deg() < 1.0);
}

TEST_CASE("scans of a cabin do not hide its ride from 4-DOF and 6-DOF: the air carries z, and it is said") {
  const auto climbed_m = [](std::int64_t stamp_ns) { return std::clamp(time_s(stamp_ns) - 2.0, 0.0, 4.0); };
  const Motion standing = [](std::int64_t) { return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.7)); };
  const MakePrior in_cabin = [&](std::int64_t stamp_ns) {
    Prior prior = perfect_prior(standing, stamp_ns);
    prior.height_m = climbed_m(stamp_ns);
    prior.ground_moves = climbed_m(stamp_ns) > 0.0 && climbed_m(stamp_ns) < 4.0;
    return prior;
  };
  for (const Method method : {Method::k4Dof, Method::k6Dof}) {
    RegistrationRun run(furnished_room(), standing, in_cabin, method);
    run.steps(40);
    CHECK(run.pose().lost == LostReason::kMovingGround);
    CHECK(run.pose().mode == PoseMode::kPriorOnly);
    CHECK_FALSE(run.pose().for_map);
    CHECK(run.pose().T_map_base.translation().z() ==
          doctest::Approx(climbed_m(run.pose().stamp_ns)).epsilon(0.02));
    run.steps(30);
    CHECK(run.pose().lost == LostReason::kNone);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.pose().T_map_base.translation().z() == doctest::Approx(4.0).epsilon(0.02));
  }
}

}  // namespace isobar::test::test_lost
