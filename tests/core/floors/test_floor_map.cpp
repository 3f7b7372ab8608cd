// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor_map.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <vector>

#include "tests/core/floors/scene.hpp"

namespace isobar::test::test_floor_map {

namespace {

/// Gives the points of a scene by tiles of 8.8 m.
void add_tiles(const Scene& scene, FloorMap& map) {
  std::map<TileKey, std::vector<MapPoint>> tiles;
  for (MapPoint point : scene.points) {
    const Eigen::Vector3d at = point.p_map / 8.8;
    point.observations = 100;
    tiles[{static_cast<std::int32_t>(std::floor(at.x())), static_cast<std::int32_t>(std::floor(at.y())),
           static_cast<std::int32_t>(std::floor(at.z()))}]
        .push_back(point);
  }
  for (const auto& [key, points] : tiles) map.set_tile(key, points);
}

/// A hall of 20 x 8 m on two floors, 3 m apart, that was driven on both.
Scene two_floors() {
  Scene scene;
  for (const double z : {0.0, 3.0}) {
    scene.add_ground(0.0, 0.0, 20.0, 8.0, z);
    // In the middle of cells: packing moves points by up to 0.1 mm.
    scene.add_wall({0.0, 0.025}, {20.0, 0.025}, z, z + 2.5);
    scene.add_wall({20.0, 7.975}, {0.0, 7.975}, z, z + 2.5);
  }
  scene.drive_to({2.0, 4.0, 0.0});
  scene.drive_to({18.0, 4.0, 0.0});
  scene.drive_to({18.0, 4.0, 3.0});  // an elevator
  scene.drive_to({4.0, 4.0, 3.0});
  return scene;
}

int cells_of(const OccupancyGrid& grid, std::int8_t value) {
  return static_cast<int>(std::count(grid.cells.begin(), grid.cells.end(), value));
}

}  // namespace

TEST_CASE("a map that comes by tiles has the floors and the grid of the whole map at once") {
  const Scene scene = two_floors();
  FloorMap map{GridConfig{}};
  add_tiles(scene, map);
  for (const Eigen::Vector3d& place : scene.path) map.drive_to(place);
  map.find();
  REQUIRE(map.floors().floors.size() == 2);
  CHECK(map.floors().floors[1].number == 1);
  CHECK(map.floors().floors[1].height_m == doctest::Approx(3.0).epsilon(0.01));

  std::vector<MapPoint> points = scene.points;
  for (MapPoint& point : points) point.observations = 100;
  GroundColumns ground;
  ground.add(points);
  ground.finish();
  const Floors floors = find_floors(ground, scene.path);
  const OccupancyGrid whole = floor_grid(points, floors, *floors.find(1), scene.path);
  const OccupancyGrid by_tiles = map.grid(*map.floors().find(1));
  CHECK(by_tiles.width == whole.width);
  CHECK(by_tiles.height == whole.height);
  int different = 0;
  for (double y = -1.025; y < 9.0; y += 0.05) {
    for (double x = -1.025; x < 21.0; x += 0.05) {
      if (whole.at({x, y}) != by_tiles.at({x, y})) ++different;
    }
  }
  CHECK(different < cells_of(whole, kCellOccupied) / 20);
}

TEST_CASE("a tile that comes again replaces its points, and an empty one removes them") {
  FloorMap map{GridConfig{}};
  const Scene scene = two_floors();
  add_tiles(scene, map);
  const std::size_t points = map.point_count();
  CHECK(points == scene.points.size());
  add_tiles(scene, map);
  CHECK(map.point_count() == points);
  Scene none;
  none.add_ground(0.0, 0.0, 1.0, 1.0, 0.0);
  map.set_tile({0, 0, 0}, none.points);
  CHECK(map.point_count() < points);
  map.set_tile({0, 0, 0}, {});
  CHECK(map.point_count() < points - none.points.size());
}

TEST_CASE("beyond the limit of points only the ground of the farthest tiles is kept, and the floors stay") {
  const Scene scene = two_floors();
  FloorMap map(GridConfig{},
               {.points = scene.points.size() * 7 / 10, .places = 400'000, .grid_cells = 7'600.0});
  add_tiles(scene, map);
  for (const Eigen::Vector3d& place : scene.path) map.drive_to(place);
  map.find();
  CHECK(map.point_count() < scene.points.size());
  REQUIRE(map.floors().floors.size() == 2);
  CHECK(map.floors().floors[0].area_m2 > 100.0);  // of 160 m2
  const OccupancyGrid grid = map.grid(map.floors().floors[1]);
  CHECK(grid.at({6.0, 0.025}) == kCellOccupied);  // near the robot, at (4, 4, 3)
  CHECK(grid.at({19.0, 0.025}) != kCellOccupied);
}

TEST_CASE("of a floor wider than the limit, the grid has the part around the robot") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 60.0, 8.0, 0.0);
  scene.add_wall({0.0, 0.025}, {60.0, 0.025}, 0.0, 2.5);
  scene.drive_to({2.0, 4.0, 0.0});
  scene.drive_to({50.0, 4.0, 0.0});
  FloorMap map(GridConfig{}, {.points = 6'000'000, .places = 400'000, .grid_cells = 600.0});  // 30 m
  add_tiles(scene, map);
  for (const Eigen::Vector3d& place : scene.path) map.drive_to(place);
  map.find();
  REQUIRE(map.floors().floors.size() == 1);
  const OccupancyGrid grid = map.grid(map.floors().floors[0]);
  CHECK(grid.width < 800);  // 30 m and a tile
  CHECK(grid.at({50.0, 4.0}) == kCellFree);
  CHECK(grid.at({10.0, 4.0}) == kCellUnknown);
}

TEST_CASE("a path without end stays bounded, keeps its first place and the floors that were driven") {
  Scene scene = two_floors();
  FloorMap map(GridConfig{}, {.points = 6'000'000, .places = 2'000, .grid_cells = 7'600.0});
  add_tiles(scene, map);
  for (const Eigen::Vector3d& place : scene.path) map.drive_to(place);
  for (int i = 0; i < 5'000; ++i) map.drive_to({4.0 + 10.0 * std::abs(std::sin(0.01 * i)), 4.0, 3.0});
  CHECK(map.place_count() <= 2'000);
  map.find();
  REQUIRE(map.floors().floors.size() == 2);
  CHECK(map.floors().floors[0].number == 0);
}

TEST_CASE("a robot that stands adds no places") {
  FloorMap map{GridConfig{}};
  for (int i = 0; i < 1'000; ++i) map.drive_to({0.001 * (i % 3), 0.0, 0.0});
  map.drive_to({NAN, 0.0, 0.0});
  CHECK(map.place_count() == 2);
}

}  // namespace isobar::test::test_floor_map
