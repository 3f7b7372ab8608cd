// SPDX-License-Identifier: BSD-3-Clause
// Hints of where the robot is: right ones end a search, wrong ones change nothing.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_place_hint {
namespace {

constexpr int kMapSteps = 40;
/// 27 hypotheses, two a scan, and three scans that confirm.
constexpr int kMostTrialSteps = 20;

double yaw_of(const Eigen::Isometry3d& T) { return std::atan2(T.linear()(1, 0), T.linear()(0, 0)); }

/// A hint at `T_map_base`, moved aside and turned.
PlaceHint hint_at(const Eigen::Isometry3d& T_map_base, double x_m, double y_m, double yaw_deg) {
  PlaceHint hint;
  hint.p_map_m = T_map_base.translation().head<2>() + Eigen::Vector2d(x_m, y_m);
  hint.yaw_rad = yaw_of(T_map_base) + yaw_deg * kRadPerDeg;
  hint.sigma_m = 0.5;
  hint.sigma_rad = 15.0 * kRadPerDeg;
  return hint;
}

/// Pose of the world in the map frame of a run whose poses are right.
Eigen::Isometry3d world_of(const RegistrationRun& run, const Motion& motion) {
  return run.pose().T_map_base * motion(run.pose().stamp_ns).inverse(Eigen::Isometry);
}

/// Steps until the hint is decided.
int decide(RegistrationRun& run) {
  int steps = 0;
  while (!run.registration().hint_report().is_decided() && steps < kMostTrialSteps) {
    run.step();
    ++steps;
  }
  return steps;
}

/// The circle; from `moved_ns` on as if somebody had carried the robot to the other side of it, which no sensor but the
/// lidar shows.
Motion carried_to_other_side(std::int64_t moved_ns) {
  return [moved_ns](std::int64_t stamp_ns) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    if (stamp_ns >= moved_ns) T.linear() = rotation_about_z(115.0 * kRadPerDeg);
    return T * circle(stamp_ns);
  };
}

}  // namespace

TEST_CASE("a robot that searches at the wrong place is found by a hint, and not without one") {
  for (const bool hinted : {true, false}) {
    CAPTURE(hinted);
    RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
    run.steps(kMapSteps);
    const std::size_t cells = run.map().cell_count();
    KnownPlace place;
    place.T_map_base = run.pose().T_map_base;
    place.T_map_base.translation().head<2>() += Eigen::Vector2d(-6.0, 5.0);
    place.overlap = run.pose().overlap;
    place.residual_rms_m = run.pose().residual_rms_m;
    const PlaceHint hint = hint_at(run.pose().T_map_base, 0.4, -0.3, 12.0);
    run.restart_at(place);
    if (hinted) run.registration().hint(hint);
    for (int i = 0; i < 2 * kMostTrialSteps && run.registration().searching(); ++i) {
      run.step();
      if (run.registration().searching()) CHECK(run.map().cell_count() == cells);
    }
    CHECK(run.pose().session == (hinted ? 1U : 2U));
    if (!hinted) continue;
    CHECK(run.registration().hint_report().outcome == HintOutcome::kFound);
    run.steps(3);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.position_error().norm() < 0.04);  // as in the search of a place
    CHECK(run.rotation_error_deg() < 0.5);
  }
}

TEST_CASE("a wrong hint to a robot that searches changes nothing: its own search goes on and ends well") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(kMapSteps);
  KnownPlace place;
  place.T_map_base = run.pose().T_map_base;
  const PlaceHint hint = hint_at(run.pose().T_map_base, 50.0, 0.0, 0.0);
  run.restart_at(place);
  run.registration().hint(hint);
  for (int i = 0; i < 2 * kMostTrialSteps && run.registration().searching(); ++i) run.step();
  CHECK(run.registration().hint_report().outcome == HintOutcome::kNoMatch);
  CHECK(run.pose().session == 1);
  run.steps(3);
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.04);
}

TEST_CASE("a wrong hint to a robot that knows its place moves nothing, to the last bit") {
  for (const Method method : {Method::k3Dof, Method::kAdaptive}) {
    for (const Eigen::Vector3d& hint : {Eigen::Vector3d(50.0, 0.0, 0.0), Eigen::Vector3d(2.2, -1.8, 80.0)}) {
      CAPTURE(hint.x());
      RegistrationRun hinted(furnished_room(), circle, drifting(circle), method);
      RegistrationRun other(furnished_room(), circle, drifting(circle), method);
      hinted.steps(kMapSteps);
      other.steps(kMapSteps);
      hinted.registration().hint(hint_at(hinted.pose().T_map_base, hint.x(), hint.y(), hint.z()));
      for (int i = 0; i < kMostTrialSteps; ++i) {
        hinted.step();
        other.step();
        CHECK(hinted.pose().T_map_base.matrix() == other.pose().T_map_base.matrix());
        CHECK(hinted.pose().covariance == other.pose().covariance);
      }
      CHECK(hinted.registration().hint_report().is_decided());
      CHECK(hinted.registration().hint_report().outcome != HintOutcome::kFound);
      CHECK(hinted.map().cell_count() == other.map().cell_count());
      CHECK(hinted.allocations() == other.allocations());
    }
  }
}

TEST_CASE("a robot that was carried away, and does not know it, goes on from a right hint") {
  for (const Method method : {Method::k3Dof, Method::kAdaptive}) {
    CAPTURE(static_cast<int>(method));
    const Motion motion = carried_to_other_side(kRunStartNs + 60 * kRunScanNs);
    RegistrationRun run(furnished_room(), motion, drifting(circle), method);
    run.steps(55);
    const Eigen::Isometry3d T_map_world = world_of(run, motion);
    const auto true_pose = [&] { return T_map_world * motion(run.pose().stamp_ns); };
    const auto error_m = [&] {
      return (run.pose().T_map_base.translation() - true_pose().translation()).norm();
    };
    run.steps(10);  // its own scans have been in the map around it for half a second
    REQUIRE(error_m() > 1.0);
    const std::size_t allocations = run.allocations();
    run.registration().hint(hint_at(true_pose(), 0.3, 0.4, -10.0));
    const int steps = decide(run);
    CHECK(steps < kMostTrialSteps);
    CHECK(run.registration().hint_report().outcome == HintOutcome::kFound);
    run.steps(5);
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.pose().lost == LostReason::kNone);
    CHECK(run.pose().session == 1);
    CHECK(error_m() < 0.06);
    CHECK(run.allocations() == allocations);
  }
}

TEST_CASE("a hint at the place that the robot knows is confirmed, and moves nothing") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.steps(kMapSteps);
  run.registration().hint(hint_at(run.pose().T_map_base, 0.2, 0.1, 5.0));
  CHECK(decide(run) < kMostTrialSteps);
  CHECK(run.registration().hint_report().outcome == HintOutcome::kConfirmed);
  CHECK(run.position_error().norm() < 0.04);
}

TEST_CASE("a hint of another map frame, of another floor, or without a map is refused as such") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  run.registration().hint(hint_at(Eigen::Isometry3d::Identity(), 0.0, 0.0, 0.0));
  run.step();
  CHECK(run.registration().hint_report().outcome == HintOutcome::kNoMap);
  run.steps(kMapSteps);
  PlaceHint hint = hint_at(run.pose().T_map_base, 0.0, 0.0, 0.0);
  hint.session = 2;
  run.registration().hint(hint);
  run.step();
  CHECK(run.registration().hint_report().outcome == HintOutcome::kOtherFrame);
  hint.session = 1;
  hint.has_z = true;
  hint.z_m = run.pose().T_map_base.translation().z() + 3.5;
  hint.z_sigma_m = 0.3;
  run.registration().hint(hint);
  run.step();
  CHECK(run.registration().hint_report().outcome == HintOutcome::kOtherHeight);
  CHECK(run.registration().hint_report().given == 3);
  CHECK(run.position_error().norm() < 0.04);
}

}  // namespace isobar::test::test_place_hint
