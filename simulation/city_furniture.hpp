// SPDX-License-Identifier: BSD-3-Clause
// Street furniture: lamps, trees, parked cars and small objects on pavements.
#pragma once

#include "simulation/city_frame.hpp"
#include "simulation/city_grid.hpp"
#include "simulation/random.hpp"
#include "simulation/terrain.hpp"

namespace isobar::simulation {

/// Length of a parked or driving car.
inline constexpr double kCarLengthM = 4.3;
/// Height of a pavement above the carriageway.
inline constexpr double kKerbM = 0.12;

/// Adds a car with its centre at u = 0, d = 0 and its wheels on z = 0.
void add_car(Mesh& mesh, const CityFrame& frame, Random& random);
/// Adds a trunk with a crown of leaves; `foot`: bottom of the trunk [m].
void add_tree(Mesh& mesh, const Eigen::Vector3d& foot, Random& random);
/// Adds lamps, trees, parked cars, posts, bins and benches along one side of a block. `kerb`: u = 0 …
/// length_m along the kerb, d > 0 on the carriageway, z = 0 at height 0 of the terrain.
void add_kerbside(Mesh& mesh, const CityFrame& kerb, double length_m, const Street& street,
                  const Terrain& terrain, Random& random);

}  // namespace isobar::simulation
