// SPDX-License-Identifier: BSD-3-Clause
// Occupancy grid of one floor, from the points of the map and the path of the robot.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/floors/floor.hpp"
#include "core/floors/floor_ground.hpp"
#include "core/floors/free_rays.hpp"
#include "core/floors/grid_config.hpp"
#include "core/floors/ground_columns.hpp"
#include "core/floors/occupancy_grid.hpp"
#include "core/map/map_point.hpp"

namespace isobar {

/// Takes the points of the map in any number of calls, so that a map of any size passes through. Occupied: surfaces
/// between GridConfig::lowest_obstacle_m and robot_height_m above the ground below them. Free: ground that was seen,
/// the path, and what lies in sight of it.
class FloorGrid {
 public:
  /// @param ground of the map, finished
  /// @param path positions of base_link in order of time [m]
  /// @throws DataError when the floor is too large for a grid of GridConfig::cells_at_most
  FloorGrid(const GroundColumns& ground, const Floors& floors, const Floor& floor,
            std::span<const Eigen::Vector3d> path, const GridConfig& config);

  /// Points of the map, each once; points of other floors are left out.
  void add(std::span<const MapPoint> points);
  /// The grid, cropped to what is known; once, after the last add().
  [[nodiscard]] OccupancyGrid finish();

 private:
  void add(const MapPoint& point);
  void draw_ground(const Eigen::Vector2d& p_cells);
  void draw_obstacle(const MapPoint& point, const Eigen::Vector2d& p_cells);
  void mark(const Eigen::Vector2d& p_cells, std::int8_t value);
  [[nodiscard]] int count_around(int x, int y, int reach,
                                 const std::function<bool(std::size_t)>& is_counted) const;
  void settle_blurred();
  void confirm();
  void block_ways_out();
  void clear_path();
  void cast_rays();
  void fill_specks();
  [[nodiscard]] ColumnIndex column_at(int x, int y) const;

  GridConfig config_;
  FloorGround ground_;
  OccupancyGrid grid_;
  std::vector<CellGround> cell_ground_;
};

/// The grid of one floor from points in memory, for a map that is being made: ground, floor and grid in one call.
/// @param points of the map, for example LocalMap::append_points()
[[nodiscard]] OccupancyGrid floor_grid(std::span<const MapPoint> points, const Floors& floors,
                                       const Floor& floor, std::span<const Eigen::Vector3d> path,
                                       const GridConfig& config = {});

}  // namespace isobar
