// SPDX-License-Identifier: BSD-3-Clause
// Cars and people that move in the streets that a robot drives through.
#pragma once

#include <vector>

#include "simulation/city_route.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// People on the pavements and oncoming cars in every street that the way leads through just once; they are
/// there while the robot can see the street. `poses` is the robot's drive along `way`.
[[nodiscard]] std::vector<MovingBody> make_traffic(const CityGrid& grid, const CityTerrain& terrain,
                                                   const CityWay& way, const std::vector<RawPose>& poses,
                                                   Random& random);

}  // namespace isobar::simulation
