// SPDX-License-Identifier: BSD-3-Clause
// People walking in corridors.
#pragma once

#include "simulation/corridor.hpp"
#include "simulation/random.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// True if a leg is long enough for a person who keeps clear of the robot's turns at its ends.
[[nodiscard]] bool can_walk(const Corridor& corridor, std::size_t leg);

/// Shape of a person standing at the origin, nearly rotationally symmetric, since moving bodies do not
/// rotate.
[[nodiscard]] Mesh make_person(Random& random);

/// A person who walks to and fro along one leg, near one wall, for `samples` samples of the time grid.
[[nodiscard]] MovingBody make_walker(const Corridor& corridor, std::size_t leg, double floor_z_m,
                                     std::size_t samples, Random& random);

}  // namespace isobar::simulation
