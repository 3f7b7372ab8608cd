// SPDX-License-Identifier: BSD-3-Clause
// Route of a vehicle through a city.
#pragma once

#include <vector>

#include "simulation/city_grid.hpp"
#include "simulation/random.hpp"
#include "simulation/route.hpp"

namespace isobar::simulation {

/// Sequence of adjacent crossings.
struct CityWay {
  std::vector<Crossing> crossings;
  std::size_t first_old = 0;  ///< index of the crossing where the return through streets driven before starts
};

/// Requirements on a way.
struct CityWayWish {
  int columns = 6;          ///< the way stays within columns 1 … columns
  double new_m = 1'800.0;   ///< length through streets not driven before
  double return_m = 200.0;  ///< length of the return to streets driven before
};

/// Plans a way in a zigzag across the city: two rows at a time, with random changes between the two.
[[nodiscard]] CityWay plan_city_way(const CityGrid& grid, const CityWayWish& wish, Random& random);

/// Number of times that a way uses the street between two adjacent crossings, in either direction.
[[nodiscard]] long times_driven(const CityWay& way, const Crossing& a, const Crossing& b);

/// Number of rows that is sufficient for a way.
[[nodiscard]] int rows_for(const CityWayWish& wish);

/// Planar route along the way (height 0; see drape() of terrain.hpp), in its lane, slow in corners, with random stops.
[[nodiscard]] Route drive_city_way(const CityGrid& grid, const CityWay& way, Random& random);

}  // namespace isobar::simulation
