// SPDX-License-Identifier: BSD-3-Clause
// Moving cars and people in the streets that a robot drives through.
#pragma once

#include <vector>

#include "simulation/city_route.hpp"
#include "simulation/terrain.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Pedestrians and oncoming cars in every street that the way uses exactly once. They exist while the robot
/// can see the street. `poses`: the robot's motion along `way`, every SplineGrid::kStepS.
[[nodiscard]] std::vector<MovingBody> make_traffic(const CityGrid& grid, const Terrain& terrain,
                                                   const CityWay& way, const std::vector<RawPose>& poses,
                                                   Random& random);

}  // namespace isobar::simulation
