// SPDX-License-Identifier: BSD-3-Clause
// A map that has been laid anew at other poses: the robot goes on in it.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/so3.hpp"
#include "tests/core/registration/registration_run.hpp"

namespace isobar::test::test_moved_map {
namespace {

constexpr int kSteps = 60;

/// A map of the same scans, each moved by `T`.
std::unique_ptr<LocalMap> moved_map(const std::vector<std::unique_ptr<RegisteredScan>>& scans,
                                    const Eigen::Isometry3d& T, std::uint32_t number) {
  auto map = std::make_unique<LocalMap>(MapConfig{}, run_lidar_mount());
  for (const auto& scan : scans) {
    const Eigen::Isometry3d before = scan->pose.T_map_base;
    scan->pose.T_map_base = T * before;
    map->update(*scan);
    scan->pose.T_map_base = before;
  }
  map->set_move({number, T});
  return map;
}

/// Drives, keeping the scans.
std::vector<std::unique_ptr<RegisteredScan>> drive(RegistrationRun& run) {
  std::vector<std::unique_ptr<RegisteredScan>> scans;
  for (int i = 0; i < kSteps; ++i) {
    run.step();
    scans.push_back(std::make_unique<RegisteredScan>(run.registered_scan()));
  }
  return scans;
}

Eigen::Isometry3d move_by(double x_m, double z_m, double yaw_deg) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_about_z(yaw_deg / 57.29578);
  T.translation() = Eigen::Vector3d(x_m, 0.5 * x_m, z_m);
  return T;
}

TEST_CASE("a robot goes on in a map that was moved, registered and without a jump but the map's") {
  for (const Method method : {Method::k3Dof, Method::k4Dof, Method::k6Dof, Method::kAdaptive}) {
    // The largest is beyond the gate of a registration: a metre, and ten degrees.
    for (const double size : {0.05, 0.3, 1.0}) {
      CAPTURE(size);
      RegistrationRun run(furnished_room(), circle, drifting(circle), method);
      const auto scans = drive(run);
      REQUIRE(run.pose().mode == PoseMode::kRegistered);
      const Eigen::Isometry3d world = run.pose().T_map_base * circle(run.pose().stamp_ns).inverse();
      const double bias_m = run.pose().altimeter.bias_m;
      const Eigen::Isometry3d T = move_by(size, 0.2 * size, 10.0 * size);
      run.exchange_map(moved_map(scans, T, 1));
      for (int i = 0; i < 20; ++i) {
        const PoseEstimate& pose = run.step();
        CAPTURE(i);
        CHECK(pose.mode == PoseMode::kRegistered);
        CHECK(pose.map_moves == 1);
        const Eigen::Isometry3d expected = T * world * circle(pose.stamp_ns);
        // The ICP in a furnished room: two centimetres, and what the two maps differ by.
        CHECK((pose.T_map_base.translation() - expected.translation()).norm() < 0.03);
      }
      // The altimeter has not moved: it departs from the map by the lift.
      if (method == Method::kAdaptive) {
        CHECK(run.pose().altimeter.bias_m - bias_m == doctest::Approx(-0.2 * size).epsilon(0.3));
      }
    }
  }
}

TEST_CASE("a scan that was registered to the map before a move does not enter the moved one") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  const auto scans = drive(run);
  auto map = moved_map(scans, move_by(0.3, 0.0, 0.0), 1);
  const auto before = map->snapshot();
  auto late = std::make_unique<RegisteredScan>(run.registered_scan());
  late->pose.stamp_ns += 2'000'000'000;
  CHECK(!map->update(*late));
  CHECK(map->snapshot() == before);
  late->pose.map_moves = 1;
  CHECK(map->update(*late));
}

TEST_CASE("two moves of which the registration sees the second only count as both") {
  RegistrationRun run(furnished_room(), circle, drifting(circle), Method::k4Dof);
  const auto scans = drive(run);
  const Eigen::Isometry3d world = run.pose().T_map_base * circle(run.pose().stamp_ns).inverse();
  const Eigen::Isometry3d both = move_by(0.1, 0.0, 1.0) * move_by(0.2, 0.05, -0.5);
  run.exchange_map(moved_map(scans, both, 2));
  const PoseEstimate& pose = run.step();
  CHECK(pose.map_moves == 2);
  CHECK((pose.T_map_base.translation() - (both * world * circle(pose.stamp_ns)).translation()).norm() < 0.03);
}

}  // namespace
}  // namespace isobar::test::test_moved_map
