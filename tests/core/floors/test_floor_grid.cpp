// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>

#include "core/errors.hpp"
#include "core/floors/find_floors.hpp"
#include "core/floors/floor_grid.hpp"
#include "tests/core/floors/scene.hpp"

namespace isobar::test::test_floor_grid {

namespace {

Floors floors_of(const Scene& scene) {
  GroundColumns ground;
  ground.add(scene.points);
  ground.finish();
  return find_floors(ground, scene.path);
}

OccupancyGrid grid_of(const Scene& scene, int number = 0) {
  const Floors floors = floors_of(scene);
  const Floor* floor = floors.find(number);
  REQUIRE(floor != nullptr);
  return floor_grid(scene.points, floors, *floor, scene.path);
}

// Centres of the occupied cells.
std::vector<Eigen::Vector2d> occupied(const OccupancyGrid& grid) {
  std::vector<Eigen::Vector2d> centres;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (grid.cells[grid.index(x, y)] != kCellOccupied) continue;
      centres.emplace_back(grid.origin_m +
                           (Eigen::Vector2d(x, y).array() + 0.5).matrix() * grid.resolution_m);
    }
  }
  return centres;
}

// A room of 6 m x 5 m, whose wall at y = 0 has a door of 1 m with a lintel, and a corridor before it. Walls are seen from
// one side each. Ground is seen in the middle of the room only, as by a lidar that looks over what is near.
Scene room_with_door() {
  Scene scene;
  scene.add_ground(0.6, 0.6, 5.4, 4.4, 0.0);
  scene.add_ceiling(0.0, 0.0, 6.0, 5.0, 2.6);
  scene.add_wall({0.0, 5.0}, {0.0, 0.0}, 0.0, 2.6);
  scene.add_wall({6.0, 0.0}, {6.0, 5.0}, 0.0, 2.6);
  scene.add_wall({6.0, 5.0}, {0.0, 5.0}, 0.0, 2.6);
  scene.add_wall({0.0, 0.0}, {2.5, 0.0}, 0.0, 2.6);
  scene.add_wall({3.5, 0.0}, {6.0, 0.0}, 0.0, 2.6);
  scene.add_wall({2.5, 0.0}, {3.5, 0.0}, 2.0, 2.6);  // lintel
  scene.add_ground(0.0, -2.0, 6.0, 0.0, 0.0);
  scene.add_wall({0.0, -2.0}, {6.0, -2.0}, 0.0, 2.6);
  scene.drive_to({1.0, -1.0, 0.0});
  scene.drive_to({3.0, -1.0, 0.0});
  scene.drive_to({3.0, 2.5, 0.0});
  return scene;
}

double distance_to_line(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = (b - a).normalized();
  return std::abs(along.x() * (p - a).y() - along.y() * (p - a).x());
}

}  // namespace

TEST_CASE("a room has walls, a free door under its lintel, a free inside and an unknown outside") {
  const OccupancyGrid grid = grid_of(room_with_door());
  for (double y = 0.05; y < 5.0; y += 0.05) {
    CHECK(std::max(grid.at({-0.01, y}), grid.at({0.01, y})) == kCellOccupied);
    CHECK(std::max(grid.at({5.99, y}), grid.at({6.01, y})) == kCellOccupied);
  }
  for (double x = 2.6; x < 3.4; x += 0.05) CHECK(grid.at({x, 0.0}) == kCellFree);
  for (double y = 0.1; y < 4.9; y += 0.05) {
    for (double x = 0.1; x < 5.9; x += 0.05) CHECK(grid.at({x, y}) == kCellFree);
  }
  for (double y = 0.2; y < 5.0; y += 0.1) {
    CHECK(grid.at({-0.15, y}) == kCellUnknown);
    CHECK(grid.at({6.15, y}) == kCellUnknown);
  }
}

TEST_CASE("every occupied cell of a room is within one cell of a wall") {
  for (const Eigen::Vector2d& p : occupied(grid_of(room_with_door()))) {
    const double off_m = std::min({std::abs(p.x()), std::abs(p.x() - 6.0), std::abs(p.y()),
                                   std::abs(p.y() - 5.0), std::abs(p.y() + 2.0)});
    CHECK(off_m <= 0.05);
  }
}

TEST_CASE(
    "a wall at an angle is drawn without gaps and within one cell, not as the staircase of the map's cells") {
  const Eigen::Vector2d a(0.0, 3.0);
  const Eigen::Vector2d b(10.0, 7.1);
  Scene scene;
  scene.add_ground(0.0, 0.0, 10.0, 3.0, 0.0);
  scene.add_wall(b, a, 0.0, 2.5);
  scene.drive_to({1.0, 1.5, 0.0});
  scene.drive_to({9.0, 1.5, 0.0});
  const OccupancyGrid grid = grid_of(scene);
  const std::vector<Eigen::Vector2d> cells = occupied(grid);
  REQUIRE(cells.size() > 150);
  for (const Eigen::Vector2d& p : cells) CHECK(distance_to_line(p, a, b) <= 0.05);
  for (double t = 0.01; t < 0.7; t += 0.001) {  // as far as ground is near
    const Eigen::Vector2d p = a + t * (b - a);
    bool drawn = false;
    for (const double dx : {-0.03, 0.0, 0.03}) {
      for (const double dy : {-0.03, 0.0, 0.03}) {
        drawn = drawn || grid.at(p + Eigen::Vector2d(dx, dy)) == kCellOccupied;
      }
    }
    CHECK(drawn);
  }
}

TEST_CASE("walls of the floor above and below are not in a grid") {
  Scene scene;
  for (const double z : {0.0, 3.0}) {
    scene.add_ground(0.0, 0.0, 12.0, 8.0, z);
    scene.add_ceiling(0.0, 0.0, 12.0, 8.0, z + 2.6);
  }
  scene.add_wall({2.0, 1.0}, {2.0, 7.0}, 0.0, 2.6);
  scene.add_wall({9.0, 1.0}, {9.0, 7.0}, 3.0, 5.6);
  scene.drive_to({5.0, 2.0, 0.0});
  scene.drive_to({11.0, 2.0, 0.0});
  scene.drive_to({13.0, 2.0, 3.0});
  scene.drive_to({4.0, 2.0, 3.0});
  const OccupancyGrid lower = grid_of(scene, 0);
  const OccupancyGrid upper = grid_of(scene, 1);
  CHECK(lower.at({2.0, 4.0}) == kCellOccupied);
  CHECK(lower.at({9.0, 4.0}) == kCellFree);
  CHECK(upper.at({2.0, 4.0}) == kCellFree);
  CHECK(upper.at({9.0, 4.0}) == kCellOccupied);
  CHECK(upper.height_m == doctest::Approx(3.0).epsilon(0.01));
}

TEST_CASE("a table is an obstacle; a threshold, a ceiling and a sign above the robot are none") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 10.0, 6.0, 0.0);
  scene.add_ground(4.0, 4.0, 5.0, 5.0, 0.72);
  scene.add_ground(7.0, 1.0, 7.3, 5.0, 0.08);
  scene.add_wall({2.0, 4.0}, {2.0, 5.0}, 1.9, 2.3);
  scene.drive_to({1.0, 2.0, 0.0});
  scene.drive_to({9.0, 2.0, 0.0});
  const OccupancyGrid grid = grid_of(scene);
  for (double x = 4.1; x < 4.9; x += 0.05) CHECK(grid.at({x, 4.5}) == kCellOccupied);
  CHECK(grid.at({7.15, 3.0}) == kCellFree);
  CHECK(grid.at({2.0, 4.5}) == kCellFree);
}

TEST_CASE("what walked by leaves no obstacle; a post, a chair, a bush and a wall that is seen twice stay") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 10.0, 6.0, 0.0);
  std::erase_if(scene.points, [](const MapPoint& p) {  // the bush hides its ground
    return std::abs(p.p_map.x() - 6.0) < 0.5 && std::abs(p.p_map.y() - 5.0) < 0.5;
  });
  const auto add_column = [&](double x, double y, int observations, int filled) {
    for (double dx = -0.09; dx < 0.1; dx += 0.09) {
      for (double z = 0.2; z < 1.5; z += 0.09) {
        MapPoint point{{x + dx, y, z}, {0.0F, 0.0F, 0.0F}, 50};
        point.observations = static_cast<std::uint8_t>(observations);
        point.filled = static_cast<std::uint8_t>(filled);
        scene.points.push_back(point);
      }
    }
  };
  add_column(1.2, 4.0, 12, 20);  // a person who passed
  add_column(3.0, 5.0, 80, 12);  // one who walked between the robot and a wall
  scene.add_wall({3.4, 5.4}, {2.6, 5.4}, 0.0, 2.0);
  add_column(4.0, 5.0, 80, 9);   // a post
  add_column(5.0, 5.0, 80, 12);  // a chair
  add_column(6.0, 5.0, 80, 27);  // a bush
  const auto wall = static_cast<std::ptrdiff_t>(scene.points.size());
  scene.add_wall({9.0, 4.5}, {7.0, 4.5}, 0.0, 2.0);  // seen seldom, but for an end
  scene.add_wall({7.0, 5.5}, {6.8, 5.5}, 0.0, 2.0);  // seen seldom, alone
  std::for_each(scene.points.begin() + wall, scene.points.end(),
                [](MapPoint& p) { p.observations = p.p_map.x() > 8.5 ? 20 : 5; });
  scene.drive_to({1.0, 2.0, 0.0});
  scene.drive_to({9.0, 2.0, 0.0});
  const OccupancyGrid grid = grid_of(scene);
  CHECK(grid.at({1.2, 4.0}) == kCellFree);
  CHECK(grid.at({3.0, 5.0}) == kCellFree);
  CHECK(grid.at({5.0, 5.0}) == kCellOccupied);
  CHECK(grid.at({4.0, 5.0}) == kCellOccupied);
  CHECK(grid.at({6.0, 5.0}) == kCellOccupied);
  CHECK(std::max(grid.at({7.5, 4.48}), grid.at({7.5, 4.52})) == kCellOccupied);
  CHECK(std::max(grid.at({6.9, 5.48}), grid.at({6.9, 5.52})) != kCellOccupied);
}

TEST_CASE("the underside of a thin deck that seems to face upwards is no ground, a floor a storey below is") {
  Scene scene;
  scene.add_ground(0.0, 0.0, 1.0, 1.0, 0.0);
  for (const double z : {-0.25, -3.0}) {
    for (const double x : {0.1, 0.15}) scene.points.push_back({{x, 0.1, z}, {0.0F, 0.0F, 1.0F}, 50});
  }
  GroundColumns ground;
  ground.add(scene.points);
  ground.finish();
  const auto surfaces = ground.at({0, 0});
  REQUIRE(surfaces.size() == 2);
  CHECK(surfaces[0].height_m == doctest::Approx(-3.0));
  CHECK(surfaces[1].height_m == doctest::Approx(0.0));
}

TEST_CASE("a grid that would be too large is refused") {
  const Scene scene = room_with_door();
  GridConfig config;
  config.cells_at_most = 1000;
  const Floors floors = floors_of(scene);
  const auto make = [&] {
    static_cast<void>(floor_grid(scene.points, floors, floors.floors[0], scene.path, config));
  };
  CHECK_THROWS_WITH_AS(make(), doctest::Contains("larger cells are needed"), DataError);
}

TEST_CASE("points that are not finite change nothing") {
  Scene scene = room_with_door();
  const OccupancyGrid before = grid_of(scene);
  scene.points.push_back({{NAN, 1.0, 1.0}, {1.0F, 0.0F, 0.0F}, 1});
  scene.points.push_back({{1.0, INFINITY, 1.0}, {0.0F, 0.0F, 1.0F}, 1});
  scene.points.push_back({{1.0, 1.0, NAN}, {0.0F, 0.0F, 1.0F}, 1});
  CHECK(grid_of(scene).cells == before.cells);
}

}  // namespace isobar::test::test_floor_grid
