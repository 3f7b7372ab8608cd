// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/floors/find_floors.hpp"
#include "tests/core/floors/scene.hpp"

namespace isobar::test::test_find_floors {

namespace {

Floors floors_of(const Scene& scene, bool with_path = true) {
  GroundColumns ground;
  ground.add(scene.points);
  ground.finish();
  return find_floors(ground, with_path ? scene.path : std::vector<Eigen::Vector3d>{});
}

// Three floors of 20 m x 6 m with ceilings, joined by ramps of 40 % beside them; driven from the middle one.
Scene three_floors(double noise_m) {
  Scene scene(noise_m);
  for (const double z : {-3.0, 0.0, 3.2}) {
    scene.add_ground(0.0, 0.0, 20.0, 6.0, z);
    scene.add_ceiling(0.0, 0.0, 20.0, 6.0, z + 2.7);
  }
  scene.drive_to({2.0, 3.0, 0.0});
  scene.drive_to({18.0, 3.0, 0.0});
  scene.drive_to({26.0, 3.0, 3.2});
  scene.drive_to({18.0, 3.0, 3.2});
  scene.drive_to({4.0, 3.0, 3.2});
  scene.drive_to({18.0, 3.0, 3.2});
  scene.drive_to({26.0, 3.0, 0.0});
  scene.drive_to({18.0, 3.0, -3.0});
  scene.drive_to({4.0, 3.0, -3.0});
  return scene;
}

}  // namespace

TEST_CASE("floors are at the driven heights under noise of 3 cm, and are numbered from the start") {
  const Floors found = floors_of(three_floors(0.03));
  REQUIRE(found.floors.size() == 3);
  const std::vector<double> heights{-3.0, 0.0, 3.2};
  for (std::size_t i = 0; i < 3; ++i) {
    const Floor& floor = found.floors[i];
    CHECK(floor.number == static_cast<int>(i) - 1);
    CHECK(floor.height_m == doctest::Approx(heights[i]).epsilon(0.0).scale(1.0).epsilon(0.02));
    CHECK(floor.area_m2 == doctest::Approx(120.0).epsilon(0.08));  // columns at the edges count wholly
    CHECK(floor.extent_m.min().isApprox(Eigen::Vector2d(0.0, 0.0), 0.3));
    CHECK((floor.extent_m.max() - Eigen::Vector2d(20.0, 6.0)).norm() < 0.3);
    CHECK(floor.certainty > 0.7);
  }
  CHECK(std::abs(found.base_height_m) < 0.03);
}

TEST_CASE("the height of base_link above the ground is taken out of the floors' heights") {
  Scene scene = three_floors(0.0);
  for (Eigen::Vector3d& p : scene.path) p.z() += 0.4;
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 3);
  CHECK(found.base_height_m == doctest::Approx(0.4).epsilon(0.02));
  CHECK(std::abs(found.floors[1].height_m) < 0.02);
}

TEST_CASE("a half-storey landing and a staircase are no floors") {
  Scene scene(0.01);
  scene.add_ground(0.0, 0.0, 20.0, 4.0, 0.0);
  scene.add_ground(0.0, 0.0, 20.0, 4.0, 3.0);
  scene.add_ground(22.5, 0.0, 25.0, 4.0, 1.5);
  scene.drive_to({2.0, 1.0, 0.0});
  scene.drive_to({20.0, 1.0, 0.0});
  scene.drive_to({22.5, 1.0, 1.5});
  scene.drive_to({24.0, 1.0, 1.5});
  scene.drive_to({24.0, 3.0, 1.5});
  scene.drive_to({22.5, 3.0, 1.5});
  scene.drive_to({20.0, 3.0, 3.0});
  scene.drive_to({2.0, 3.0, 3.0});
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 2);
  CHECK(found.floors[0].number == 0);
  CHECK(found.floors[1].height_m == doctest::Approx(3.0).epsilon(0.02));
}

TEST_CASE(
    "floors that an elevator has passed are counted where the building tells its storeys, and only there") {
  struct Case {
    std::vector<double> heights;  // in the order in which they are driven
    std::vector<int> numbers;     // ascending
  };
  for (const Case& test : {Case{{0.0, 3.4, 10.3}, {0, 1, 3}},     // 2.03 storeys
                           Case{{10.3, 0.0, 3.4}, {-3, -2, 0}},   // from the top
                           Case{{0.0, 4.6, 7.8}, {0, 1, 2}},      // a tall ground floor: 1.44 storeys
                           Case{{0.0, 10.5}, {0, 1}},             // nothing tells the storeys
                           Case{{0.0, 3.2, 11.2}, {0, 1, 2}}}) {  // 2.5 storeys
    Scene scene(0.01);
    for (const double z : test.heights) {
      scene.add_ground(0.0, 0.0, 20.0, 4.0, z);
      scene.drive_to({2.0, 2.0, z});
      scene.drive_to({18.0, 2.0, z});
      scene.drive_to({2.0, 2.0, z});
    }
    const Floors found = floors_of(scene);
    REQUIRE(found.floors.size() == test.numbers.size());
    for (std::size_t i = 0; i < found.floors.size(); ++i) CHECK(found.floors[i].number == test.numbers[i]);
  }
}

TEST_CASE(
    "after stairs or an elevator the ground that comes is no slope of the floor below, however short that "
    "was") {
  for (const bool by_stairs : {true, false}) {
    Scene scene(0.01);
    scene.add_ground(0.0, 0.0, 6.0, 4.0, 0.0);
    scene.drive_to({1.0, 2.0, 0.0});
    scene.drive_to({5.0, 2.0, 0.0});
    if (by_stairs) {
      scene.drive_to({8.0, 2.0, 1.6});
      scene.drive_to({9.0, 2.0, 1.6});
      scene.drive_to({9.0, 3.5, 1.6});
      scene.drive_to({8.0, 3.5, 1.6});
      scene.drive_to({5.0, 3.5, 3.2});
    } else {
      scene.drive_to({5.0, 2.0, 3.2});
    }
    scene.drive_to({5.0, 4.0, 3.2});
    const Floors found = floors_of(scene);
    REQUIRE(found.floors.size() == 1);
    CHECK_FALSE(found.floors[0].is_terrain);
    CHECK(found.floors[0].highest_m < 0.5);
    CHECK(floor_at(found, scene.path.back(), 0.05).place == FloorPlace::kBetween);
  }
}

TEST_CASE("a mezzanine is a half level of its own height, and changes no number") {
  Scene scene(0.01);
  scene.add_ground(0.0, 0.0, 30.0, 10.0, 0.0);
  scene.add_ground(30.0, 0.0, 40.0, 10.0, 1.4);
  scene.add_ground(0.0, 0.0, 30.0, 10.0, 3.2);
  scene.drive_to({2.0, 5.0, 0.0});
  scene.drive_to({25.0, 5.0, 0.0});
  scene.drive_to({31.0, 5.0, 1.4});
  scene.drive_to({39.0, 5.0, 1.4});
  scene.drive_to({31.0, 5.0, 1.4});
  scene.drive_to({25.0, 5.0, 3.2});
  scene.drive_to({2.0, 5.0, 3.2});
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 2);
  CHECK(found.floors[1].number == 1);
  REQUIRE(found.half_levels.size() == 1);
  CHECK(found.half_levels[0].height_m == doctest::Approx(1.4).epsilon(0.02));
  CHECK(found.half_levels[0].driven_m > 8.0);
}

TEST_CASE("a ramp for wheelchairs joins two floors and is none") {
  Scene scene;
  for (const double z : {0.0, 2.4}) scene.add_ground(0.0, 0.0, 20.0, 6.0, z);
  scene.add({20.0, 0.0, 0.0}, {60.0, 0.0, 2.4}, {0.0, 6.0, 0.0});  // 4 %
  scene.drive_to({2.0, 3.0, 0.0});
  scene.drive_to({20.0, 3.0, 0.0});
  scene.drive_to({80.0, 3.0, 2.4});
  scene.drive_to({80.0, 9.0, 2.4});
  scene.drive_to({10.0, 9.0, 2.4});
  scene.drive_to({10.0, 3.0, 2.4});
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 2);
  CHECK(found.floors[0].highest_m < 0.1);
  CHECK(found.floors[1].lowest_m > 2.3);
}

TEST_CASE("an elevator joins two floors without a level between them") {
  Scene scene(0.01);
  scene.add_ground(0.0, 0.0, 15.0, 4.0, 9.0);
  scene.add_ground(0.0, 0.0, 15.0, 4.0, 0.0);
  scene.drive_to({14.0, 2.0, 9.0});
  scene.drive_to({2.0, 2.0, 9.0});
  scene.drive_to({2.0, 2.0, 0.0});
  scene.drive_to({14.0, 2.0, 0.0});
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 2);
  CHECK(found.floors[0].number == -1);
  CHECK(found.half_levels.empty());
}

TEST_CASE("a hill is one floor of terrain, whatever its level places are") {
  Scene scene;
  for (int i = 0; i < 60; ++i) {  // 5 % up, with a level place every 60 m
    const double x = 5.0 * i;
    const double z = 0.25 * (i - i / 12 * 3);
    scene.drive_to({x, 0.0, i % 12 < 9 ? z : scene.path.back().z()});
  }
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 1);
  CHECK(found.floors[0].is_terrain);
  CHECK(found.floors[0].number == 0);
  CHECK(found.floors[0].highest_m > 8.0);
}

TEST_CASE("a map without a path has floors where the most ground is, with less certainty") {
  const Scene scene = three_floors(0.02);
  const Floors found = floors_of(scene, false);
  REQUIRE(found.floors.size() == 3);
  CHECK(found.floors[1].number == 0);
  CHECK(std::abs(found.floors[2].height_m - 3.2) < 0.05);
  CHECK(found.floors[1].certainty < floors_of(scene).floors[1].certainty);
}

TEST_CASE("a robot that stands still on an empty map is on floor 0; nothing at all has no floor") {
  Scene scene;
  scene.drive_to({1.0, 1.0, 0.5});
  const Floors found = floors_of(scene);
  REQUIRE(found.floors.size() == 1);
  CHECK(found.floors[0].number == 0);
  CHECK(found.floors[0].height_m == doctest::Approx(0.5));
  CHECK(found.floors[0].certainty < 0.5);
  CHECK(floors_of(Scene{}).floors.empty());
}

TEST_CASE("places of a path that are not finite are left out") {
  Scene scene = three_floors(0.0);
  scene.path.insert(scene.path.begin() + 40, {NAN, 0.0, INFINITY});
  CHECK(floors_of(scene).floors.size() == 3);
}

}  // namespace isobar::test::test_find_floors
