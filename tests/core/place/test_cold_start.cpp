// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/place/cold_start.hpp"
#include "core/so3.hpp"
#include "tests/core/place/building.hpp"

namespace isobar::test::test_cold_start {
namespace {

bool at(const PlaceCandidate& candidate, const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d turn = candidate.T_map_base.linear().transpose() * T.linear();
  return (candidate.T_map_base.translation() - T.translation()).norm() < 0.1 &&
         rotation_angle_rad(Eigen::Quaterniond(turn)) < 1.0 * kRadPerDeg;
}

/// Result at `T_world_level` of `world`, in the map of `in_map`.
ColdStartResult start(const Building& in_map, const Building& world, const Eigen::Isometry3d& T_world_level,
                      double sigma_m = 0.15, const std::optional<SearchArea>& hint = {}) {
  static PlaceQuery query;
  world.look(T_world_level, query);
  const KnownMap map = in_map.map();
  ColdStart cold_start;
  // The altimeter is off by one sigma.
  return cold_start.locate(
      {map, query, Eigen::Matrix3d::Identity(), {T_world_level.translation().z() + sigma_m, sigma_m}}, hint);
}

/// A room with a cabinet that is not symmetric, `x_m` to the right.
void add_room(Building& building, double x_m, double z_m = 0.0) {
  building.add_room({x_m, 0.0, z_m}, {x_m + 6.0, 4.5, z_m + 3.0});
  building.add_obstacle({x_m + 1.0, 3.5, z_m}, {x_m + 2.2, 4.5, z_m + 1.9});
  building.add_obstacle({x_m + 4.8, 0.0, z_m}, {x_m + 5.4, 1.4, z_m + 2.2});
}

}  // namespace

TEST_CASE("a robot finds itself anywhere in the map, with any heading") {
  for (const Eigen::Isometry3d& T :
       {level_pose_at(1.1, -0.7, 0.0, 40.0), level_pose_at(-3.9, 3.1, 0.0, -170.0),
        level_pose_at(14.3, 0.6, 0.0, -75.0), level_pose_at(19.0, -2.2, 0.0, 121.0)}) {
    CAPTURE(T.translation().x());
    const ColdStartResult result = start(office(), office(), T);
    CHECK(result.verdict == ColdStartVerdict::kFound);
    REQUIRE(!result.candidates.empty());
    CHECK(at(result.candidates.front(), T));
    CHECK(result.complete);
  }
}

TEST_CASE("roll and pitch of gravity are part of the pose") {
  const Eigen::Isometry3d T = level_pose_at(1.1, -0.7, 0.0, 40.0);
  PlaceQuery query;
  office().look(T, query);
  const KnownMap map = office().map();
  ColdStart cold_start;
  const Eigen::Matrix3d R_level_base = exp_so3({0.1, -0.05, 0.0}).toRotationMatrix();
  const ColdStartResult& result = cold_start.locate({map, query, R_level_base, {0.0, 0.15}});
  REQUIRE(result.verdict == ColdStartVerdict::kFound);
  Eigen::Isometry3d T_map_base = T;
  T_map_base.linear() = T.linear() * R_level_base;
  CHECK(at(result.candidates.front(), T_map_base));
}

TEST_CASE("identical rooms are ambiguous, and all of them are named") {
  Building building;
  add_room(building, 0.0);
  add_room(building, 10.0);
  const ColdStartResult result = start(building, building, level_pose_at(2.6, 1.7, 0.0, 25.0));
  CHECK(result.verdict == ColdStartVerdict::kAmbiguous);
  for (const double x_m : {2.6, 12.6}) {
    const Eigen::Isometry3d T = level_pose_at(x_m, 1.7, 0.0, 25.0);
    const auto found = std::find_if(result.candidates.begin(), result.candidates.end(),
                                    [&](const PlaceCandidate& one) { return at(one, T); });
    REQUIRE(found != result.candidates.end());
    CHECK(found->weight > 0.2);
  }
}

TEST_CASE("along a bare corridor no place is claimed") {
  Building building;
  building.add_room({-60.0, -1.2, 0.0}, {60.0, 1.2, 2.6}, 1U | 2U);
  const ColdStartResult result = start(building, building, level_pose_at(4.0, 0.1, 0.0, 10.0));
  CHECK(result.verdict != ColdStartVerdict::kFound);
}

TEST_CASE("a place that is not in the map is unknown") {
  Building elsewhere;
  elsewhere.add_room({-3.1, -2.2, 0.0}, {4.4, 6.3, 2.6});
  elsewhere.add_obstacle({0.9, 2.0, 0.0}, {1.7, 4.1, 1.4});
  elsewhere.add_obstacle({-2.2, 3.0, 0.0}, {-1.0, 3.6, 2.2});
  const ColdStartResult result = start(office(), elsewhere, level_pose_at(-0.5, 0.3, 0.0, 40.0));
  CHECK(result.verdict == ColdStartVerdict::kUnknown);
  CHECK(result.candidates.empty());
}

TEST_CASE("the mirror image of a building is another building") {
  Building mirrored;
  mirrored.add_room({-5.0, -4.0, 0.0}, {5.0, 4.0, 3.0});
  mirrored.add_obstacle({2.0, -3.2, 0.0}, {3.0, -2.0, 1.8});
  mirrored.add_obstacle({-4.2, 1.8, 0.0}, {-3.0, 3.0, 1.2});
  mirrored.add_obstacle({3.5, 1.5, 0.0}, {4.0, 2.5, 2.2});
  const ColdStartResult result = start(office(), mirrored, level_pose_at(1.1, 0.7, 0.0, -40.0));
  CHECK(result.verdict != ColdStartVerdict::kFound);
}

TEST_CASE("furniture that was moved since does not hide the place") {
  Building refurnished = office();
  refurnished.add_obstacle({-1.0, 2.4, 0.0}, {0.2, 3.2, 1.5});
  const Eigen::Isometry3d T = level_pose_at(1.1, -0.7, 0.0, 40.0);
  const ColdStartResult result = start(office(), refurnished, T);
  CHECK(result.verdict == ColdStartVerdict::kFound);
  REQUIRE(!result.candidates.empty());
  CHECK(at(result.candidates.front(), T));
}

TEST_CASE("of identical floors the height tells the right one; where it does not, the floor is ambiguous") {
  Building tower;
  for (const double z_m : {0.0, 4.0, 8.0}) add_room(tower, 0.0, z_m);
  for (const double z_m : {0.0, 4.0, 8.0}) {
    CAPTURE(z_m);
    const Eigen::Isometry3d T = level_pose_at(2.6, 1.7, z_m, 25.0);
    const ColdStartResult sure = start(tower, tower, T);
    CHECK(sure.verdict == ColdStartVerdict::kFound);
    REQUIRE(!sure.candidates.empty());
    CHECK(at(sure.candidates.front(), T));
  }
  const ColdStartResult doubt = start(tower, tower, level_pose_at(2.6, 1.7, 4.0, 25.0), 2.0);
  CHECK(doubt.verdict == ColdStartVerdict::kAmbiguous);
  const auto climbs = [&](double z_m) {
    return std::any_of(doubt.candidates.begin(), doubt.candidates.end(), [&](const PlaceCandidate& one) {
      return at(one, level_pose_at(2.6, 1.7, z_m, 25.0));
    });
  };
  CHECK(climbs(4.0));
  CHECK(climbs(8.0));
}

TEST_CASE("a floor that the map does not have is unknown") {
  Building building;
  add_room(building, 0.0);
  Building upper;
  add_room(upper, 0.0, 4.0);
  CHECK(start(building, upper, level_pose_at(2.6, 1.7, 4.0, 25.0)).verdict == ColdStartVerdict::kUnknown);
}

TEST_CASE("a hint decides between identical rooms, and is refused where nothing fits near it") {
  Building building;
  add_room(building, 0.0);
  add_room(building, 10.0);
  const Eigen::Isometry3d T = level_pose_at(12.6, 1.7, 0.0, 25.0);
  const SearchArea near{12.2, 2.1, 0.2, {0.5, 0.5}, 0.3};
  const ColdStartResult found = start(building, building, T, 0.15, near);
  CHECK(found.verdict == ColdStartVerdict::kFound);
  REQUIRE(!found.candidates.empty());
  CHECK(at(found.candidates.front(), T));
  const SearchArea wrong{2.5, 2.0, 2.0, {0.5, 0.5}, 0.3};
  CHECK(start(building, building, T, 0.15, wrong).verdict == ColdStartVerdict::kHintRefused);
  const SearchArea outside{60.0, 2.0, 0.2, {0.5, 0.5}, 0.3};
  CHECK(start(building, building, T, 0.15, outside).verdict == ColdStartVerdict::kHintRefused);
}

TEST_CASE("a height or a hint that is no number finds nothing, and does no harm") {
  const double nan = std::nan("");
  PlaceQuery query;
  office().look(level_pose_at(1.1, -0.7, 0.0, 40.0), query);
  const KnownMap map = office().map();
  ColdStart cold_start;
  for (const SlabHeight& height :
       {SlabHeight{nan, 0.1}, SlabHeight{0.0, nan}, SlabHeight{1e30, 0.1}, SlabHeight{0.0, -1.0}}) {
    CHECK(cold_start.locate({map, query, Eigen::Matrix3d::Identity(), height}).verdict ==
          ColdStartVerdict::kUnknown);
  }
  const ColdStartInput input{map, query, Eigen::Matrix3d::Identity(), {0.0, 0.15}};
  CHECK(cold_start.locate(input, SearchArea{nan, 0.0, 0.0, {1.0, 1.0}, 0.3}).verdict ==
        ColdStartVerdict::kHintRefused);
  CHECK(cold_start.locate(input, SearchArea{0.0, 0.0, nan, {1.0, 1.0}, 0.3}).verdict ==
        ColdStartVerdict::kHintRefused);
  CHECK(cold_start.locate(input, SearchArea{0.0, 0.0, 0.0, {nan, 1.0}, 0.3}).verdict ==
        ColdStartVerdict::kHintRefused);
}

}  // namespace isobar::test::test_cold_start
