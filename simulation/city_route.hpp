// SPDX-License-Identifier: BSD-3-Clause
// Where a vehicle drives in a city.
#pragma once

#include <vector>

#include "simulation/city_grid.hpp"
#include "simulation/city_terrain.hpp"
#include "simulation/random.hpp"
#include "simulation/route.hpp"

namespace isobar::simulation {

/// Crossing after crossing, neighbours in the grid.
struct CityWay {
  std::vector<Crossing> crossings;
  std::size_t first_old = 0;  ///< from this crossing on the way comes back through streets of before
};

/// What a way should be like.
struct CityWayWish {
  int columns = 6;          ///< it stays within columns 1 … columns
  double new_m = 1'800.0;   ///< through streets that it has never been in
  double return_m = 200.0;  ///< then back to streets of before
};

/// Winds from end to end of the city, two rows at a time, changing between them at random; rows from 1 on.
[[nodiscard]] CityWay plan_city_way(const CityGrid& grid, const CityWayWish& wish, Random& random);

/// How often a way leads through the street between two neighbours, either way.
[[nodiscard]] long times_driven(const CityWay& way, const Crossing& a, const Crossing& b);

/// Rows that a way of this kind may need.
[[nodiscard]] int rows_for(const CityWayWish& wish);

/// Drives the way in its lane, slowly round corners, with a stop now and then; in plan, at height 0.
[[nodiscard]] Route drive_city_way(const CityGrid& grid, const CityWay& way, Random& random);

/// Puts poses of a plan on the ground: height, pitch and roll of the terrain.
void drape(std::vector<RawPose>& poses, const CityTerrain& terrain);

}  // namespace isobar::simulation
