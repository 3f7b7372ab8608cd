// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/merge/building_merger.hpp"
#include "core/so3.hpp"
#include "tests/core/merge/ring_session.hpp"

namespace isobar::test::test_building_merger {
namespace {

Eigen::Isometry3d frame(double x_m, double y_m, double z_m, double yaw_deg) {
  return Eigen::Translation3d(x_m, y_m, z_m) *
         Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Eigen::Vector3d::UnitZ());
}

const Eigen::Isometry3d kFrameOfB = frame(3.0, -7.0, 0.4, 70.0);

/// A whole round, and three quarters of one by another robot: driven once, since that takes most of the time.
RingSession& session_a() {
  static RingSession a({.until_m = 42.0});
  return a;
}
RingSession& session_b() {
  static RingSession b({.T_map_world = kFrameOfB, .from_m = 15.0, .until_m = 45.0});
  return b;
}

MergedBuilding merge(RingSession& a, RingSession& b, const HeightRelation& height) {
  const MergeSide side_a = a.side();
  const MergeSide side_b = b.side();
  const KnownMap map_a = a.known_map();
  return BuildingMerger({}, side_a, map_a, side_b).run(height);
}

/// Largest error of a key scan of B in the frame of A, which is the world's.
double error_m(const MergedBuilding& merged, const RingSession& b) {
  double most_m = 0.0;
  const JoinedBuildings& joined = merged.joined;
  for (std::size_t i = joined.submaps_of_a; i < joined.building.submaps.size(); ++i) {
    for (KeyScan key : joined.building.submaps[i].keys) {
      const Eigen::Vector3d p = key.T_map_base.translation();
      key.stamp_ns -= joined.b_later_ns;
      most_m = std::max(most_m, (p - b.truth(key).translation()).norm());
    }
  }
  return most_m;
}

TEST_CASE("a session that starts elsewhere comes to lie where it was driven") {
  RingSession& a = session_a();
  RingSession& b = session_b();
  // The altimeters' zeros are those of the frames; they are off by their bias of 0.1 m.
  const MergedBuilding merged = merge(a, b, {-0.4 + 0.1, 0.3});
  REQUIRE(merged.problem.empty());
  CHECK(merged.figures.loops >= 3);
  // The noise of ICP and chain over the ring, in x, y and z: 2 cm. Where B was placed it was 5 m and 70 degrees off.
  CHECK(error_m(merged, b) < 0.04);
  CHECK(merged.figures.rms_m < 0.03);
  const Eigen::Isometry3d left = merged.figures.T_a_b * kFrameOfB;
  CHECK(left.translation().norm() < 0.05);
  CHECK(std::abs(yaw_of(left.linear())) < 0.3 * kRadPerDeg);
}

TEST_CASE("the joined building is numbered, timed and measured on, and holds all of both") {
  RingSession& a = session_a();
  RingSession& b = session_b();
  const MergedBuilding merged = merge(a, b, {-0.4, 0.3});
  REQUIRE(merged.problem.empty());
  const std::vector<Submap>& submaps = merged.joined.building.submaps;
  const auto keys_of = [](const std::vector<Submap>& of) {
    std::size_t keys = 0;
    for (const Submap& submap : of) keys += submap.keys.size();
    return keys;
  };
  CHECK(keys_of(submaps) == keys_of(a.storage().stored.submaps) + keys_of(b.storage().stored.submaps));
  for (std::size_t i = 0; i < submaps.size(); ++i) CHECK(submaps[i].number == i);
  // B was driven at the time of A: its stamps follow, so that no bias of the altimeter is that of the other robot.
  const Submap& first = submaps[merged.joined.submaps_of_a];
  const Submap& last = submaps[merged.joined.submaps_of_a - 1];
  CHECK(first.stamp_ns > last.stamp_ns);
  CHECK(first.first_way_m > last.last_way_m);
  // It opens as a building of one run does.
  Building building({}, {}, {}, RingRun::lidar_mount());
  building.continue_from(merged.joined.building);
  CHECK(building.loops().size() == merged.joined.building.loops.size());
  const KeyScan& key = first.keys.front();
  const Eigen::Isometry3d T = building.T_map_submap(merged.joined.submaps_of_a) * key.T_submap_base;
  CHECK((T.translation() - key.T_map_base.translation()).norm() < 1e-6);
}

TEST_CASE("a floor that looks the same is another floor by its height, and nothing is joined") {
  RingSession& a = session_a();
  RingSession b({.T_map_world = kFrameOfB, .from_m = 15.0, .until_m = 40.0, .storey_m = 3.2});
  const MergedBuilding merged = merge(a, b, {-0.4, 0.3});
  CHECK_FALSE(merged.problem.empty());
  CHECK(merged.figures.frame.located == 0);
  CHECK(merged.figures.tried == 0);
}

TEST_CASE("a session in another building does not fit") {
  World hall;
  hall.add_box({-4.0, -2.5, 0.0}, {15.5, 12.0, 3.4});
  hall.add_box({3.0, 2.5, 0.0}, {8.0, 5.0, 3.4});
  hall.add_box({-4.0, 6.0, 0.0}, {-2.0, 8.0, 2.0});
  hall.add_box({10.0, -2.5, 0.0}, {12.0, -1.4, 1.8});
  RingSession& a = session_a();
  RingSession b({.T_map_world = kFrameOfB, .until_m = 30.0, .world = hall});
  const MergedBuilding merged = merge(a, b, {-0.4, 0.3});
  CHECK_FALSE(merged.problem.empty());
}

TEST_CASE("scans that cannot be read are left out, and the rest fits") {
  RingSession& a = session_a();
  RingSession& b = session_b();
  b.storage().lost_every = 4;
  const MergedBuilding merged = merge(a, b, {-0.4, 0.3});
  b.storage().lost_every = 0;
  REQUIRE(merged.problem.empty());
  CHECK(error_m(merged, b) < 0.05);
}

TEST_CASE("without a common height the place is found among all levels") {
  RingSession& a = session_a();
  RingSession& b = session_b();
  const MergedBuilding merged = merge(a, b, {});
  REQUIRE(merged.problem.empty());
  CHECK(error_m(merged, b) < 0.05);
}

}  // namespace
}  // namespace isobar::test::test_building_merger
