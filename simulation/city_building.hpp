// SPDX-License-Identifier: BSD-3-Clause
// Houses of a city.
#pragma once

#include "simulation/city_frame.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// A house from u = 0 to width_m whose front is at d = 0 and looks along +d: shops and doors on the street,
/// windows above, now and then bay windows, balconies and a cornice. z = 0 is the pavement before its middle.
void add_building(Mesh& mesh, const CityFrame& frame, double width_m, double depth_m, Random& random);

}  // namespace isobar::simulation
