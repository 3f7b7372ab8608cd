// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/scan_motion.hpp"

#include <doctest/doctest.h>

#include <memory>

#include "core/geometry.hpp"
#include "tests/core/contradictions/room.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_scan_motion {

namespace {

constexpr std::int64_t kStart = 1'000'000'000'000;

Eigen::Isometry2d pose(double x_m, double y_m, double yaw_rad) {
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.translation() = Eigen::Vector2d(x_m, y_m);
  T.linear() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return T;
}

/// The step from one pose of the lidar to the next; `mount` is both configured and true.
ScanStep step_between(const Room& room, const Eigen::Isometry2d& from, const Eigen::Isometry2d& to,
                      const Eigen::Isometry3d& mount = Eigen::Isometry3d::Identity()) {
  const auto scan = std::make_unique<Scan>();
  ScanMotion motion(mount);
  scan_room(room, from, mount.linear(), kStart, *scan);
  CHECK_FALSE(motion.add(*scan));
  scan_room(room, to, mount.linear(), kStart + 100'000'000, *scan);
  const auto step = motion.add(*scan);
  REQUIRE(step);
  return *step;
}

}  // namespace

TEST_CASE("a step in a room is found to millimetres and milliradians, turns of 25 deg a scan included") {
  for (const double turn_rad : {0.0, 0.03, -0.2, 0.44}) {
    const Eigen::Isometry2d from = pose(0.4, -0.2, 0.7);
    const ScanStep step = step_between({}, from, from * pose(0.12, 0.03, turn_rad));
    CHECK(step.turn_known);
    CHECK(step.way_known);
    CHECK(step.step.turn_rad == doctest::Approx(turn_rad).epsilon(0.01).scale(0.2));
    CHECK(step.step.x_m == doctest::Approx(0.12).epsilon(0.05));
    CHECK(std::abs(step.step.y_m - 0.03) < 0.006);
  }
}

TEST_CASE("the way is that of base_link: a lidar ahead of it moves sideways in a turn on the spot") {
  Eigen::Isometry3d mount = Eigen::Isometry3d::Identity();
  mount.translation() = Eigen::Vector3d(0.5, 0.0, 0.6);
  const Eigen::Isometry2d lever = pose(0.5, 0.0, 0.0);
  const ScanStep step = step_between({}, lever, pose(0.0, 0.0, 0.1) * lever, mount);
  CHECK(step.step.turn_rad == doctest::Approx(0.1).epsilon(0.02));
  CHECK(std::abs(step.step.x_m) < 0.006);
  CHECK(std::abs(step.step.y_m) < 0.006);
}

TEST_CASE("a lidar on its side is used in axes of base_link") {
  Eigen::Isometry3d mount = Eigen::Isometry3d::Identity();
  mount.linear() = rotation_from_rpy_deg({180.0, 0.0, 90.0});
  const ScanStep step = step_between({}, pose(0, 0, 0), pose(0.1, 0.0, 0.05), mount);
  CHECK(step.step.turn_rad == doctest::Approx(0.05).epsilon(0.03));
  CHECK(step.step.x_m == doctest::Approx(0.1).epsilon(0.05));
}

TEST_CASE("along a bare corridor the turn is known and the way is not") {
  const Room corridor{-500.0, 500.0, -1.0, 1.2};
  const ScanStep step = step_between(corridor, pose(0, 0, 0), pose(0.3, 0.0, 0.05));
  CHECK(step.turn_known);
  CHECK(step.step.turn_rad == doctest::Approx(0.05).epsilon(0.05));
  CHECK_FALSE(step.way_known);
}

TEST_CASE("two places that have nothing in common tell no motion") {
  const ScanStep step = step_between({}, pose(0, 0, 0), pose(0, 0, 0));
  CHECK(step.way_known);
  const auto scan = std::make_unique<Scan>();
  ScanMotion motion(Eigen::Isometry3d::Identity());
  scan_room({-3.0, 5.0, -2.5, 3.5}, pose(0, 0, 0), Eigen::Matrix3d::Identity(), kStart, *scan);
  motion.add(*scan);
  scan_room({-30.0, 20.0, -14.0, 9.0}, pose(0, 0, 0.3), Eigen::Matrix3d::Identity(), kStart + 100'000'000,
            *scan);
  const auto other = motion.add(*scan);
  REQUIRE(other);
  CHECK_FALSE(other->turn_known);
  CHECK_FALSE(other->way_known);
}

TEST_CASE("after a gap, or from an empty scan, nothing follows; a scan allocates nothing") {
  const auto scan = std::make_unique<Scan>();
  ScanMotion motion(Eigen::Isometry3d::Identity());
  scan_room({}, pose(0, 0, 0), Eigen::Matrix3d::Identity(), kStart, *scan);
  motion.add(*scan);
  scan->stamp_ns += 500'000'000;
  scan->end_stamp_ns += 500'000'000;
  CHECK_FALSE(motion.add(*scan));
  scan->stamp_ns += 100'000'000;
  scan->end_stamp_ns += 100'000'000;
  const std::size_t before = allocation_count();
  CHECK(motion.add(*scan));
  CHECK(allocation_count() == before);
  scan->point_count = 0;
  scan->stamp_ns += 100'000'000;
  scan->end_stamp_ns += 100'000'000;
  CHECK_FALSE(motion.add(*scan));
}

}  // namespace isobar::test::test_scan_motion
