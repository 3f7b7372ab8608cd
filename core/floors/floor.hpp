// SPDX-License-Identifier: BSD-3-Clause
// Floors of a building: levels on which the robot drives.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/floors/floor_place.hpp"

namespace isobar {

/// One floor, in the map frame. `lowest_m` … `highest_m` is the ground that was driven level.
struct Floor {
  /// 0: the floor nearest to where the run began; the next known one up: +1, or more where the distance is a multiple of
  /// the building's storeys.
  int number = 0;
  double height_m = 0.0;  ///< of the ground, mean
  double lowest_m = 0.0;
  double highest_m = 0.0;
  Eigen::AlignedBox2d extent_m;  ///< of the ground in plan; empty without ground
  double area_m2 = 0.0;          ///< of the ground that the map holds
  double driven_m = 0.0;         ///< level drive on it; 0 without a path
  double certainty = 0.0;        ///< that this is a floor, 0 … 1
  bool is_provisional = false;   ///< the robot has just arrived on it, see FirstArrival
  bool is_terrain = false;       ///< slopes of open country, where no place lies above another
};

/// A level that is no floor of its own: a landing, a split level, or a mezzanine less than FloorConfig::least_storey_m
/// from a floor.
struct HalfLevel {
  double height_m = 0.0;  ///< of the ground in the map frame
  double driven_m = 0.0;
  double area_m2 = 0.0;
};

/// Result of find_floors().
struct Floors {
  std::vector<Floor> floors;           ///< ascending in height and number
  std::vector<HalfLevel> half_levels;  ///< ascending in height
  double base_height_m = 0.0;          ///< of base_link above the ground, from path and map
  double start_m = 0.0;                ///< height of the ground where the run began

  /// The floor of a number; null if there is none.
  [[nodiscard]] const Floor* find(int number) const;
  /// Ground heights that belong to the grid of a floor [m]: the floor's own, up to half-way to its neighbours, at
  /// most kReachM beyond; a ramp to another floor is in both grids, up to there.
  struct Slab {
    double lowest_m = 0.0;
    double highest_m = 0.0;
    [[nodiscard]] bool contains(double height_m) const {
      return height_m >= lowest_m && height_m <= highest_m;
    }
  };
  static constexpr double kReachM = 1.5;
  [[nodiscard]] Slab slab_of(const Floor& floor) const;
};

/// What a floor is. The defaults hold for buildings that people walk in.
struct FloorConfig {
  double least_storey_m = 2.0;     ///< between two floors; people do not walk below less
  double most_level_slope = 0.03;  ///< of a drive that counts as level; accessible ramps have 0.06 to 0.08
  double least_drive_m = 2.5;      ///< level drive that makes a floor; on landings it is shorter
  double least_area_m2 = 8.0;      ///< of ground that makes a floor; landings are smaller
};

/// The floor at a place. `floor` is null without floors.
struct FloorGuess {
  const Floor* floor = nullptr;
  double certainty = 0.0;                   ///< 0 … 1: near 0 between floors, on a ramp or in an elevator
  FloorPlace place = FloorPlace::kUnknown;  ///< kOnFloor from a certainty of 0.5 on
};

/// Floor of a robot whose base_link is at `p_map_base` [m], of a height with standard deviation `sigma_m`.
[[nodiscard]] FloorGuess floor_at(const Floors& floors, const Eigen::Vector3d& p_map_base, double sigma_m);

}  // namespace isobar
