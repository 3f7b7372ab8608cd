// SPDX-License-Identifier: BSD-3-Clause
// Occupancy grid, with the values and the order of nav_msgs/OccupancyGrid.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isobar {

/// Values of a cell.
inline constexpr std::int8_t kCellUnknown = -1;
inline constexpr std::int8_t kCellFree = 0;
inline constexpr std::int8_t kCellOccupied = 100;

/// Cells in rows along x, from the lowest y upwards: cell (x, y) is cells[y * width + x].
struct OccupancyGrid {
  double resolution_m = 0.05;                          ///< edge of a cell
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< corner of cell (0, 0) in the map frame
  double height_m = 0.0;                               ///< of the floor's ground in the map frame
  int width = 0;
  int height = 0;
  std::vector<std::int8_t> cells;

  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  /// Value at a place in the map frame [m]; kCellUnknown outside.
  [[nodiscard]] std::int8_t at(const Eigen::Vector2d& p_map) const;
};

/// The part of a grid that holds known cells, with a margin of unknown cells; empty if all are unknown.
[[nodiscard]] OccupancyGrid cropped(const OccupancyGrid& grid, int margin);

}  // namespace isobar
