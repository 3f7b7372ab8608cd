// SPDX-License-Identifier: BSD-3-Clause
// Numbers of floors.
#pragma once

#include <vector>

#include "core/floors/floor.hpp"

namespace isobar {

/// Distances of two floors, one above the other, that are usual for a storey of a building.
inline constexpr double kLowestStoreyM = 2.6;
inline constexpr double kHighestStoreyM = 5.5;

/// Height of a storey, from two floors that lie one above the other: the smallest distance that a storey can have; 0 where
/// there is none. `floors`: ascending in height.
[[nodiscard]] double storey_m(const std::vector<Floor>& floors);

/// Numbers floors from the one nearest to the start: the next one up is +1, or more where two floors tell the height of a
/// storey and the distance is a multiple of it.
/// @param floors ascending in height
/// @param start_m height of the ground where the run began, map frame [m]
void number_floors(std::vector<Floor>& floors, double start_m);

}  // namespace isobar
