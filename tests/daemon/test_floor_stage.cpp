// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/floor_stage.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/core/floors/scene.hpp"

namespace isobar::test::test_floor_stage {

namespace {

/// A hall of 20 x 8 m on two floors, 3 m apart.
FloorTiles hall(std::uint32_t session) {
  Scene scene;
  for (const double z : {0.0, 3.0}) {
    scene.add_ground(0.0, 0.0, 20.0, 8.0, z);
    scene.add_wall({0.0, 0.025}, {20.0, 0.025}, z, z + 2.5);  // in the middle of cells
  }
  for (MapPoint& point : scene.points) point.observations = 100;
  return {session, 0, {{{0, 0, 0}, scene.points}}, true};
}

PoseEstimate pose_at(const Eigen::Vector3d& p_map_base, std::uint32_t session = 1) {
  PoseEstimate pose;
  pose.mode = PoseMode::kRegistered;
  pose.session = session;
  pose.stamp_ns = 5'000'000'000;
  pose.T_map_base.translation() = p_map_base;
  pose.covariance = 1e-4 * Matrix6d::Identity();
  return pose;
}

void drive(FloorStage& stage, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  for (int i = 0; i <= 100; ++i) stage.add_pose(pose_at(from + (to - from) * 0.01 * i));
}

}  // namespace

TEST_CASE(
    "the floor is told once it was driven, with its name; in an elevator it is the last one, not known") {
  FloorStage stage{GridConfig{}};
  stage.add_pose(pose_at({2.0, 4.0, 0.0}));
  CHECK_FALSE(stage.current().known);
  CHECK(std::isnan(stage.current().z_m));
  CHECK_FALSE(stage.grid().has_value());
  drive(stage, {2.0, 4.0, 0.0}, {18.0, 4.0, 0.0});
  stage.add_tiles(hall(1));
  stage.set_names(files::FloorNames::parse("[[floor]]\nheight_m = 0.0\nname = \"Hall\"\n", "floors.toml"));
  stage.find();
  const ipc::CurrentFloor below = stage.current();
  CHECK(below.known);
  CHECK(below.place == FloorPlace::kOnFloor);
  CHECK(below.number == 0);
  CHECK(below.certainty > 0.9);
  CHECK(std::string(below.name) == "Hall");
  CHECK(below.stamp_ns == 5'000'000'000);

  stage.add_pose(pose_at({18.0, 4.0, 1.4}));
  const ipc::CurrentFloor between = stage.current();
  CHECK_FALSE(between.known);
  CHECK(between.place == FloorPlace::kBetween);
  CHECK(between.number == 0);
  CHECK(std::string(between.name) == "Hall");

  drive(stage, {18.0, 4.0, 3.0}, {4.0, 4.0, 3.0});
  stage.find();
  const ipc::CurrentFloor above = stage.current();
  CHECK(above.known);
  CHECK(above.number == 1);
  CHECK(above.z_m == doctest::Approx(3.0).epsilon(0.01));
  CHECK(std::string(above.name).empty());
  const std::optional<OccupancyGrid> grid = stage.grid();
  REQUIRE(grid.has_value());
  CHECK(grid->height_m == doctest::Approx(3.0).epsilon(0.01));
  CHECK(grid->at({10.0, 0.025}) == kCellOccupied);
  CHECK(grid->at({10.0, 4.0}) == kCellFree);
}

TEST_CASE("another map frame begins with nothing, and tiles of the one before are left out") {
  FloorStage stage{GridConfig{}};
  drive(stage, {2.0, 4.0, 0.0}, {18.0, 4.0, 0.0});
  drive(stage, {18.0, 4.0, 3.0}, {4.0, 4.0, 3.0});
  stage.add_tiles(hall(1));
  stage.find();
  REQUIRE(stage.map().floors().floors.size() == 2);
  REQUIRE(stage.current().number == 1);
  stage.add_pose(pose_at({0.0, 0.0, 0.0}, 2));
  stage.add_tiles(hall(1));
  stage.find();
  CHECK(stage.current().session == 2);
  CHECK(stage.current().number == 0);  // where it begins
  CHECK(stage.map().floors().floors.size() <= 1);
  CHECK(stage.map().point_count() == 0);
}

TEST_CASE(
    "a map that was laid anew brings its tiles again; those of the one before are left out, and the floor is "
    "still told") {
  FloorStage stage{GridConfig{}};
  drive(stage, {2.0, 4.0, 0.0}, {18.0, 4.0, 0.0});
  stage.add_tiles(hall(1));
  stage.find();
  PoseEstimate moved = pose_at({17.0, 4.0, 0.05});
  moved.map_moves = 1;
  stage.add_pose(moved);
  CHECK(stage.map().point_count() == 0);
  CHECK(stage.current().known);
  stage.add_tiles(hall(1));
  CHECK(stage.map().point_count() == 0);
  FloorTiles anew = hall(1);
  anew.map_moves = 1;
  stage.add_tiles(anew);
  CHECK(stage.map().point_count() > 0);
  stage.find();
  CHECK(stage.current().known);
  CHECK(stage.current().number == 0);
}

TEST_CASE("a robot that is lost has no floor, and its dead reckoning is no way") {
  FloorStage stage{GridConfig{}};
  drive(stage, {2.0, 4.0, 0.0}, {18.0, 4.0, 0.0});
  stage.add_tiles(hall(1));
  stage.find();
  const std::size_t places = stage.map().place_count();
  PoseEstimate lost = pose_at({30.0, 4.0, 0.0});
  lost.lost = LostReason::kTurn;
  stage.add_pose(lost);
  CHECK_FALSE(stage.current().known);
  CHECK(stage.current().place == FloorPlace::kUnknown);
  CHECK(stage.map().place_count() == places);
}

TEST_CASE("a run that is continued knows the floors that were driven before, once their tiles have come") {
  FloorStage stage{GridConfig{}};
  Scene scene;
  scene.drive_to({2.0, 4.0, 0.0});
  scene.drive_to({18.0, 4.0, 0.0});
  scene.drive_to({18.0, 4.0, 3.0});
  scene.drive_to({4.0, 4.0, 3.0});
  stage.begin(1, scene.path);
  stage.add_tiles(hall(1));
  stage.add_pose(pose_at({10.0, 4.0, 3.0}));
  stage.find();
  CHECK(stage.current().known);
  CHECK(stage.current().number == 1);
  stage.set_names(files::FloorNames::parse("[[floor]]\nheight_m = 0.0\nname = \"Hall\"\n", "floors.toml"));
  const ipc::KnownFloors known = stage.known();
  REQUIRE(known.count == 2);
  CHECK(known.session == 1);
  CHECK(known.floors[0].number == 0);
  CHECK(std::string(known.floors[0].name) == "Hall");
  CHECK(known.floors[1].number == 1);
  CHECK(known.floors[1].z_m == doctest::Approx(3.0).epsilon(0.01));
  CHECK(stage.known() == known);
  stage.begin(2, {});
  CHECK_FALSE(stage.known() == known);
}

}  // namespace isobar::test::test_floor_stage
