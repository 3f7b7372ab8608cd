// SPDX-License-Identifier: BSD-3-Clause
// Floors of a map.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/floors/floor.hpp"
#include "core/floors/ground_columns.hpp"

namespace isobar {

/// Floors are the heights at which the robot drove level and the map holds ground. What lies between them (ramps,
/// staircases, elevators, landings) is none; a level less than a storey from a floor is a HalfLevel. Where no place
/// was driven at two heights and little of the way is level, the whole is one floor of terrain.
/// @param ground of the map, finished
/// @param path positions of base_link in the map frame, in order of time [m]. Empty: floors are the heights with
///        the most ground, with less certainty, and 0 is the one nearest to the height 0.
[[nodiscard]] Floors find_floors(const GroundColumns& ground, std::span<const Eigen::Vector3d> path,
                                 const FloorConfig& config = {});

}  // namespace isobar
