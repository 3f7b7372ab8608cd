// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/floors/floor.hpp"

namespace isobar::test::test_floor_at {

namespace {

Floors three() {
  Floors floors;
  for (int i = -1; i <= 1; ++i) {
    Floor floor;
    floor.number = i;
    floor.height_m = floor.lowest_m = floor.highest_m = 3.0 * i;
    floor.extent_m = {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(20.0, 20.0)};
    floors.floors.push_back(floor);
  }
  floors.base_height_m = 0.3;
  return floors;
}

}  // namespace

TEST_CASE("a robot on a floor is told so with near certainty, between floors with none") {
  const Floors floors = three();
  const FloorGuess up = floor_at(floors, {5.0, 5.0, 3.3}, 0.05);
  REQUIRE(up.floor != nullptr);
  CHECK(up.floor->number == 1);
  CHECK(up.certainty > 0.95);
  CHECK(floor_at(floors, {5.0, 5.0, 1.8}, 0.05).certainty < 0.01);
  // Half a metre up a ramp the floor is still the likeliest, but less sure.
  const FloorGuess ramp = floor_at(floors, {5.0, 5.0, 0.75}, 0.05);
  CHECK(ramp.floor->number == 0);
  CHECK(ramp.certainty < 0.8);
}

TEST_CASE("certainty falls with the uncertainty of the height, down to the share of one floor") {
  const Floors floors = three();
  double last = 1.0;
  for (const double sigma_m : {0.02, 0.3, 1.0, 3.0, 30.0}) {
    const FloorGuess guess = floor_at(floors, {5.0, 5.0, 0.3}, sigma_m);
    CHECK(guess.floor->number == 0);
    CHECK(guess.certainty < last);
    last = guess.certainty;
  }
  CHECK(last < 0.34);
}

TEST_CASE(
    "far from all floors the nearest is named with certainty 0, and a height that is no number with none") {
  const Floors floors = three();
  const FloorGuess far = floor_at(floors, {5.0, 5.0, 900.0}, 0.05);
  REQUIRE(far.floor != nullptr);
  CHECK(far.floor->number == 1);
  CHECK(far.certainty == doctest::Approx(0.0));
  CHECK(floor_at(floors, {0.0, 0.0, NAN}, 0.05).certainty == 0.0);
  CHECK(floor_at({}, {0.0, 0.0, 0.0}, 0.05).floor == nullptr);
}

TEST_CASE("a place is on a floor, on a half level, between floors, or unknown where the height is") {
  Floors floors = three();
  floors.half_levels.push_back({1.5, 3.0, 6.0});
  CHECK(floor_at(floors, {5.0, 5.0, 3.3}, 0.05).place == FloorPlace::kOnFloor);
  CHECK(floor_at(floors, {5.0, 5.0, 1.8}, 0.05).place == FloorPlace::kHalfLevel);
  CHECK(floor_at(floors, {5.0, 5.0, 1.1}, 0.05).place == FloorPlace::kBetween);
  CHECK(floor_at(floors, {5.0, 5.0, 1.8}, 5.0).place == FloorPlace::kUnknown);  // 3 m are within one sigma
  CHECK(floor_at({}, {5.0, 5.0, 1.8}, 0.05).place == FloorPlace::kUnknown);
  CHECK(floor_at(floors, {5.0, 5.0, NAN}, 0.05).place == FloorPlace::kUnknown);
}

TEST_CASE("of two floors of nearly one height, the one that is known at the place is told") {
  Floors floors = three();
  floors.floors[1].extent_m = {Eigen::Vector2d(100.0, 0.0), Eigen::Vector2d(120.0, 20.0)};
  floors.floors[2].height_m = floors.floors[2].lowest_m = floors.floors[2].highest_m = 0.1;
  CHECK(floor_at(floors, {110.0, 5.0, 0.35}, 0.3).floor->number == 0);
  CHECK(floor_at(floors, {10.0, 5.0, 0.35}, 0.3).floor->number == 1);
}

TEST_CASE("the slab of a floor ends half-way to its neighbours, and at most 1.5 m beyond it") {
  const Floors floors = three();
  const Floors::Slab middle = floors.slab_of(floors.floors[1]);
  CHECK(middle.lowest_m == doctest::Approx(-1.5));
  CHECK(middle.highest_m == doctest::Approx(1.5));
  Floors near = floors;
  near.floors[2].height_m = near.floors[2].lowest_m = 2.2;
  CHECK(near.slab_of(near.floors[1]).highest_m == doctest::Approx(1.1));
}

}  // namespace isobar::test::test_floor_at
