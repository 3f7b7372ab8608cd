// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <memory>
#include <numbers>

#include "core/floors/find_floors.hpp"
#include "core/floors/floor_grid.hpp"
#include "core/map/local_map.hpp"
#include "tests/core/floors/scene.hpp"

namespace isobar::test::test_floor_grid_ways {

namespace {

OccupancyGrid grid_of(const Scene& scene, int number) {
  GroundColumns ground;
  ground.add(scene.points);
  ground.finish();
  const Floors floors = find_floors(ground, scene.path);
  const Floor* floor = floors.find(number);
  REQUIRE(floor != nullptr);
  return floor_grid(scene.points, floors, *floor, scene.path);
}

// Two floors of 20 m x 4 m, and a ramp of 10 % from one to the other, beyond their ends in x and back beside them.
Scene floors_with_ramp() {
  Scene scene(0.01);
  for (const double z : {0.0, 3.0}) {
    scene.add_ground(0.0, 0.0, 20.0, 4.0, z);
    scene.add_ceiling(0.0, 0.0, 20.0, 4.0, z + 2.6);
  }
  const Eigen::Vector3d up(30.0, 0.0, 3.0);
  scene.add({20.0, 0.0, 0.0}, up, {0.0, 4.0, 0.0});
  scene.add_ground(50.0, 0.0, 54.0, 13.0, 3.0);
  scene.add_ground(0.0, 9.0, 50.0, 13.0, 3.0);
  scene.add_ground(0.0, 4.0, 4.0, 9.0, 3.0);
  scene.drive_to({2.0, 2.0, 0.0});
  scene.drive_to({20.0, 2.0, 0.0});
  scene.drive_to({50.0, 2.0, 3.0});
  scene.drive_to({52.0, 2.0, 3.0});
  scene.drive_to({52.0, 11.0, 3.0});
  scene.drive_to({2.0, 11.0, 3.0});
  scene.drive_to({2.0, 2.0, 3.0});
  scene.drive_to({18.0, 2.0, 3.0});
  return scene;
}

// A room of 12 m x 12 m around the lidar, 1 m above its ground; a person of 0.4 m stands at (3, 0) while `person`.
double range_in_room(const Eigen::Vector3d& d, bool person) {
  double range = 1e9;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(d[axis]) > 1e-6) range = std::min(range, 6.0 / std::abs(d[axis]));
  }
  if (d.z() < 0.0) range = std::min(range, 1.0 / -d.z());
  if (!person || d.x() <= 0.0) return range;
  const double flat = std::hypot(d.x(), d.y());
  const double off = 3.0 * d.y() / flat;
  if (std::abs(off) >= 0.2) return range;
  return std::min(range, (3.0 * d.x() / flat - std::sqrt(0.04 - off * off)) / flat);
}

// Scans of a lidar that turns slightly, so that its rings cover the walls.
void see_room(LocalMap& map, std::int64_t& stamp_ns, int seconds, bool person) {
  const auto scan = std::make_unique<RegisteredScan>();
  for (int s = 0; s < seconds; ++s) {
    scan->pose = {};
    scan->pose.stamp_ns = stamp_ns += 1'000'000'000;
    scan->pose.mode = PoseMode::kRegistered;
    scan->pose.overlap = 1.0;
    scan->point_count = 0;
    for (int i = 0; i < 900; ++i) {
      for (int ring = 0; ring < 32; ++ring) {
        const double azimuth = 0.4 * i * std::numbers::pi / 180.0;
        const double elevation = (-15.5 + ring) * std::numbers::pi / 180.0;
        const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const Eigen::Vector3f p = (range_in_room(d, person) * d).cast<float>();
        scan->points[scan->point_count++] =
            ScanPoint{p.x(), p.y(), p.z(), 0, static_cast<std::uint8_t>(ring), 50};
      }
    }
    map.update(*scan);
  }
}

OccupancyGrid grid_of_map(const LocalMap& map) {
  std::vector<MapPoint> points;
  map.append_points(points);
  GroundColumns ground;
  ground.add(points);
  ground.finish();
  std::vector<Eigen::Vector3d> path{{0.0, 0.0, 0.0}};
  Floors floors;
  floors.base_height_m = 1.0;
  Floor floor;
  floor.height_m = floor.lowest_m = floor.highest_m = -1.0;
  floors.floors.push_back(floor);
  return floor_grid(points, floors, floors.floors[0], path);
}

int occupied_around(const OccupancyGrid& grid, double x, double y, double reach_m) {
  int count = 0;
  for (double dy = -reach_m; dy <= reach_m; dy += 0.05) {
    for (double dx = -reach_m; dx <= reach_m; dx += 0.05) {
      count += grid.at({x + dx, y + dy}) == kCellOccupied ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("a ramp is no wall: it is free in the grids of both floors, each up to half-way") {
  const Scene scene = floors_with_ramp();
  const OccupancyGrid lower = grid_of(scene, 0);
  const OccupancyGrid upper = grid_of(scene, 1);
  for (double x = 20.5; x < 34.5; x += 0.25) CHECK(lower.at({x, 1.0}) == kCellFree);
  for (double x = 35.6; x < 49.5; x += 0.25) CHECK(upper.at({x, 1.0}) == kCellFree);
  for (double x = 36.0; x < 49.0; x += 0.25) CHECK(lower.at({x, 1.0}) == kCellUnknown);
  for (double x = 20.5; x < 34.0; x += 0.25) CHECK(upper.at({x, 1.0}) == kCellUnknown);
  for (const OccupancyGrid& grid : {lower, upper}) {
    CHECK(std::count(grid.cells.begin(), grid.cells.end(), kCellOccupied) == 0);
  }
}

TEST_CASE("an edge, and the steps that lead down from it, are not free") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 10.0, 6.0, 0.0);
  for (int step = 1; step <= 8; ++step) {
    scene.add_ground(10.0 + 0.3 * (step - 1), 2.0, 10.0 + 0.3 * step, 4.0, -0.18 * step);
  }
  scene.add_wall({12.4, 4.0}, {12.4, 2.0}, -1.5, 2.5);  // behind the stairs
  scene.drive_to({1.0, 3.0, 0.0});
  scene.drive_to({9.0, 3.0, 0.0});
  const OccupancyGrid grid = grid_of(scene, 0);
  for (double x = 10.6; x < 12.3; x += 0.1) CHECK(grid.at({x, 3.0}) == kCellUnknown);
  CHECK(grid.at({9.9, 3.0}) == kCellFree);
}

TEST_CASE("stairs that lead up are an obstacle, unless the robot drove them") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 10.0, 6.0, 0.0);
  for (int step = 1; step <= 16; ++step) {
    const double x = 10.0 + 0.3 * (step - 1);
    scene.add_ground(x, 2.0, x + 0.3, 4.0, 0.18 * step);
    scene.add_wall({x, 2.0}, {x, 4.0}, 0.18 * (step - 1), 0.18 * step);
  }
  scene.drive_to({1.0, 3.0, 0.0});
  scene.drive_to({9.0, 3.0, 0.0});
  const OccupancyGrid closed = grid_of(scene, 0);
  CHECK(occupied_around(closed, 10.4, 3.0, 0.3) > 5);
  scene.drive_to({10.0, 3.0, 0.1});
  scene.drive_to({14.8, 3.0, 2.88});
  scene.add_ground(14.8, 0.0, 30.0, 6.0, 2.88);
  scene.drive_to({29.0, 3.0, 2.88});
  scene.drive_to({14.8, 3.0, 2.88});
  scene.drive_to({10.0, 3.0, 0.1});
  scene.add_ground(0.0, 0.0, 10.0, 6.0, 2.88);
  const OccupancyGrid open = grid_of(scene, 0);
  CHECK(open.at({10.4, 3.0}) == kCellFree);
  CHECK(open.at({11.2, 3.0}) == kCellFree);
}

TEST_CASE("a ray clears nothing far beyond the last ground that was seen, unless it meets a wall near it") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 6.0, 6.0, 0.0);
  scene.add_wall({8.8, 6.0}, {8.8, 0.0}, 0.0, 2.5);  // 2.8 m without ground before it
  scene.add_wall({0.0, 7.5}, {0.0, 0.0}, 0.0, 2.5);
  scene.add_wall({6.0, 7.5}, {0.0, 7.5}, 0.0, 2.5);  // 1.5 m without ground before it
  scene.drive_to({1.0, 3.0, 0.0});
  scene.drive_to({5.0, 3.0, 0.0});
  const OccupancyGrid grid = grid_of(scene, 0);
  CHECK(std::max(grid.at({8.78, 3.0}), grid.at({8.82, 3.0})) == kCellOccupied);
  CHECK(grid.at({7.5, 3.0}) == kCellUnknown);
  CHECK(grid.at({3.0, 7.0}) == kCellFree);
}

TEST_CASE("a person who has left is not in the grid, and the walls stay") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  std::int64_t stamp_ns = 0;
  see_room(map, stamp_ns, 5, true);
  const OccupancyGrid with_person = grid_of_map(map);
  CHECK(occupied_around(with_person, 3.0, 0.0, 0.4) > 3);
  see_room(map, stamp_ns, 12, false);
  const OccupancyGrid after = grid_of_map(map);
  CHECK(occupied_around(after, 3.0, 0.0, 0.4) == 0);
  CHECK(occupied_around(after, 6.0, 0.0, 0.4) > 10);
}

}  // namespace isobar::test::test_floor_grid_ways
