// SPDX-License-Identifier: BSD-3-Clause
// Blocks of a city with the streets around them.
#pragma once

#include <cstdint>

#include "simulation/city_grid.hpp"
#include "simulation/city_terrain.hpp"
#include "simulation/mesh.hpp"

namespace isobar::simulation {

/// Adds one block from axis to axis of the streets around it: ground, kerbs, houses or an open square, and
/// what stands before them. The same (seed, block) always looks the same, whatever else is built.
void add_block(Mesh& mesh, const CityGrid& grid, const CityTerrain& terrain, const Crossing& block,
               std::uint64_t seed);

}  // namespace isobar::simulation
