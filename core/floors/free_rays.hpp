// SPDX-License-Identifier: BSD-3-Clause
// Free space seen from a path: rays in an occupancy grid.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/floors/occupancy_grid.hpp"

namespace isobar {

/// What the map says about the ground of a cell.
enum class CellGround : std::uint8_t {
  kUnseen,   ///< nothing
  kSeen,     ///< ground of the floor
  kBlocked,  ///< an edge, or the way to another floor: no ray goes on
};

/// Marks unknown cells as free along rays from places of the path. A ray ends before the first occupied or blocked
/// cell; without an obstacle it clears no farther than the last cell whose ground was seen, and after
/// `most_unseen_m` without ground nothing beyond: what a ray crosses there may be a shaft.
class FreeRays {
 public:
  /// `ground`: one a cell of `grid`.
  FreeRays(OccupancyGrid& grid, std::span<const CellGround> ground, double ray_m, double most_unseen_m);

  /// Rays in all directions from a place in the map frame [m].
  void cast_from(const Eigen::Vector2d& p_map);

 private:
  void cast(const Eigen::Vector2d& from_cells, const Eigen::Vector2d& direction);

  OccupancyGrid& grid_;
  std::span<const CellGround> ground_;
  double ray_cells_;
  double most_unseen_cells_;
  std::vector<std::size_t> passed_;  // scratch: cells of a ray
};

}  // namespace isobar
