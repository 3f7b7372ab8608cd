// SPDX-License-Identifier: BSD-3-Clause
// Blocks of a city, with the adjacent halves of the streets around them.
#pragma once

#include <cstdint>

#include "simulation/city_grid.hpp"
#include "simulation/mesh.hpp"
#include "simulation/terrain.hpp"

namespace isobar::simulation {

/// Adds one block, bounded by the axes of the streets around it: ground, kerbs, street furniture, and houses
/// or an open square. The block depends on (seed, block) only, not on what else is built.
void add_block(Mesh& mesh, const CityGrid& grid, const Terrain& terrain, const Crossing& block,
               std::uint64_t seed);

}  // namespace isobar::simulation
