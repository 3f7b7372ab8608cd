// SPDX-License-Identifier: BSD-3-Clause
// Candidates of floors: heights that were driven level, or that hold much ground.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/floors/ground_columns.hpp"
#include "core/floors/level_drive.hpp"

namespace isobar {

/// Ground heights without a gap [m].
struct FloorLevel {
  double lowest_m = 0.0;
  double highest_m = 0.0;
  double height_m = 0.0;  ///< mean, weighted by way or by area
  double driven_m = 0.0;
  double area_m2 = 0.0;
  Eigen::AlignedBox2d extent_m;
};

/// Height of the path above the ground below it [m], median; 0 where the map holds no ground below it.
[[nodiscard]] double height_above_ground_m(const GroundColumns& ground, std::span<const DrivenPlace> places);

/// Levels of the level places, ascending. `base_height_m`: of the path above the ground.
[[nodiscard]] std::vector<FloorLevel> levels_of_drive(std::span<const DrivenPlace> places,
                                                      double base_height_m);

/// Levels that hold the most ground, ascending: for maps without a path. Two are at least `least_gap_m` apart.
[[nodiscard]] std::vector<FloorLevel> levels_of_ground(const GroundColumns& ground, double least_gap_m);

/// Fills area and extent of levels in any order; ground counts to each level that it is near to.
void measure_ground(const GroundColumns& ground, std::span<FloorLevel> levels);

}  // namespace isobar
