// SPDX-License-Identifier: BSD-3-Clause
// Houses of a city.
#pragma once

#include "simulation/city_frame.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// Adds a house from u = 0 to width_m with its front at d = 0, facing +d: doors and shops on the ground
/// floor, windows above, random bay windows, balconies and a cornice. z = 0 is the pavement at the middle of
/// the front.
void add_building(Mesh& mesh, const CityFrame& frame, double width_m, double depth_m, Random& random);

}  // namespace isobar::simulation
