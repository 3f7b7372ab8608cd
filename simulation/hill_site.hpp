// SPDX-License-Identifier: BSD-3-Clause
// A hill without buildings: uneven ground with trees, bushes and rocks.
#pragma once

#include <vector>

#include "simulation/mesh.hpp"
#include "simulation/random.hpp"
#include "simulation/terrain.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// Ground and plants within the lidar's range of a way. The ground is the terrain plus an unevenness of
/// centimetres; no plant or rock is within 1.4 m of the way. Each patch of the hill depends on its place and on
/// `seed` only.
[[nodiscard]] Mesh build_hill(const Terrain& terrain, const std::vector<RawPose>& way, std::uint64_t seed);

}  // namespace isobar::simulation
