// SPDX-License-Identifier: BSD-3-Clause
// People who walk up and down a corridor.
#pragma once

#include "simulation/corridor.hpp"
#include "simulation/random.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Whether a leg is long enough that a walker and a robot that turns at its ends do not meet.
[[nodiscard]] bool can_walk(const Corridor& corridor, std::size_t leg);

/// Shape of someone who stands at the origin; bodies do not turn, so it looks about the same from all sides.
[[nodiscard]] Mesh make_person(Random& random);

/// Someone who walks to and fro along one leg, near one wall, for `samples` steps of the time grid.
[[nodiscard]] MovingBody make_walker(const Corridor& corridor, std::size_t leg, double floor_z_m,
                                     std::size_t samples, Random& random);

}  // namespace isobar::simulation
