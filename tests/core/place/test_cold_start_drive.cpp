// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/place/cold_start.hpp"
#include "tests/core/place/building.hpp"

namespace isobar::test::test_cold_start_drive {
namespace {

/// A room that a wall divides: what is behind it, is seen only past its end.
void add_divided_room(Building& building, double x_m, double cabinet_m) {
  building.add_room({x_m, 0.0, 0.0}, {x_m + 6.0, 9.0, 3.0});
  building.add_obstacle({x_m, 4.4, 0.0}, {x_m + 4.6, 4.6, 3.0});
  building.add_obstacle({x_m + 1.0, 3.0, 0.0}, {x_m + 1.8, 4.4, 1.9});
  building.add_obstacle({x_m + cabinet_m, 7.0, 0.0}, {x_m + cabinet_m + 1.2, 8.2, 2.0});
}

Building two_rooms() {
  Building building;
  add_divided_room(building, 0.0, 0.8);
  add_divided_room(building, 10.0, 2.6);
  return building;
}

}  // namespace

TEST_CASE("places that look alike are told apart by driving on") {
  const Building building = two_rooms();
  const KnownMap map = building.map();
  const Eigen::Isometry3d T_first = level_pose_at(11.0, 1.5, 0.0, 30.0);
  const Eigen::Isometry3d T_second = level_pose_at(15.2, 4.6, 0.0, 100.0);
  PlaceQuery query;
  ColdStart cold_start;
  building.look(T_first, query);
  const ColdStartInput input{map, query, Eigen::Matrix3d::Identity(), {0.0, 0.15}};
  REQUIRE(cold_start.locate(input).verdict == ColdStartVerdict::kAmbiguous);

  building.look(T_second, query);
  Eigen::Isometry3d odometry = T_first.inverse() * T_second;
  odometry.translation().x() += 0.1;
  const ColdStartResult& result = cold_start.follow(input, odometry);
  CHECK(result.verdict == ColdStartVerdict::kFound);
  REQUIRE(!result.candidates.empty());
  CHECK((result.candidates.front().T_map_base.translation() - T_second.translation()).norm() < 0.1);
}

TEST_CASE("a second look from the same place leaves in doubt what was in doubt") {
  const Building building = two_rooms();
  const KnownMap map = building.map();
  PlaceQuery query;
  ColdStart cold_start;
  building.look(level_pose_at(11.0, 1.5, 0.0, 30.0), query);
  const ColdStartInput input{map, query, Eigen::Matrix3d::Identity(), {0.0, 0.15}};
  REQUIRE(cold_start.locate(input).verdict == ColdStartVerdict::kAmbiguous);
  for (int i = 0; i < 3; ++i) {
    CHECK(cold_start.follow(input, Eigen::Isometry3d::Identity()).verdict == ColdStartVerdict::kAmbiguous);
  }
}

TEST_CASE(
    "candidates that the next place contradicts are dropped, and the place is unknown when none is left") {
  const Building building = two_rooms();
  const KnownMap map = building.map();
  PlaceQuery query;
  ColdStart cold_start;
  building.look(level_pose_at(11.0, 1.5, 0.0, 30.0), query);
  const ColdStartInput input{map, query, Eigen::Matrix3d::Identity(), {0.0, 0.15}};
  REQUIRE(cold_start.locate(input).verdict == ColdStartVerdict::kAmbiguous);
  office().look(level_pose_at(1.1, -0.7, 0.0, 40.0), query);
  const ColdStartResult& result = cold_start.follow(input, level_pose_at(0.3, 0.0, 0.0, 0.0));
  CHECK(result.verdict == ColdStartVerdict::kUnknown);
  CHECK(result.candidates.empty());
}

}  // namespace isobar::test::test_cold_start_drive
