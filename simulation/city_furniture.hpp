// SPDX-License-Identifier: BSD-3-Clause
// What stands on pavements and along kerbs.
#pragma once

#include "simulation/city_frame.hpp"
#include "simulation/city_grid.hpp"
#include "simulation/city_terrain.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// Length of a parked or driving car.
inline constexpr double kCarLengthM = 4.3;
/// Height of a pavement above the carriageway.
inline constexpr double kKerbM = 0.12;

/// A car whose middle is at u = 0, d = 0 and that stands on z = 0.
void add_car(Mesh& mesh, const CityFrame& frame, Random& random);
/// A trunk with a crown of leaves.
void add_tree(Mesh& mesh, const Eigen::Vector3d& foot, Random& random);
/// Lamps, trees, parked cars, posts, bins, benches along one side of a block: u = 0 … length_m along the
/// kerb, d > 0 on the carriageway; z = 0 of `kerb` is height 0 of the terrain.
void add_kerbside(Mesh& mesh, const CityFrame& kerb, double length_m, const Street& street,
                  const CityTerrain& terrain, Random& random);

}  // namespace isobar::simulation
