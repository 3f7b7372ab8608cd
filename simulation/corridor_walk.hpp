// SPDX-License-Identifier: BSD-3-Clause
// The way of a robot along a corridor.
#pragma once

#include <vector>

#include "simulation/corridor.hpp"
#include "simulation/random.hpp"
#include "simulation/route.hpp"

namespace isobar::simulation {

/// A drive through a whole corridor.
struct CorridorWalk {
  double floor_m = 0.0;
  bool forwards = true;
  double skip_first_m = 0.0;  ///< left out at the beginning
  double skip_last_m = 0.0;   ///< left out at the end
};

/// Appends waypoints along a corridor, with small random lateral offsets.
void append_walk(std::vector<Waypoint>& way, const Corridor& corridor, const CorridorWalk& walk,
                 Random& random);

}  // namespace isobar::simulation
