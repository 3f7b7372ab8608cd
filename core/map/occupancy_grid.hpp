// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace isobar {

/// Occupancy of one floor seen from above, in a map frame whose z is vertical.
struct OccupancyGrid {
  static constexpr std::int8_t kUnknown = -1;
  static constexpr std::int8_t kFree = 0;
  static constexpr std::int8_t kOccupied = 100;

  double resolution_m = 0.05;  ///< edge of a cell, > 0
  double origin_x_m = 0.0;     ///< corner of the first cell with the smallest x and y, map frame
  double origin_y_m = 0.0;
  std::uint32_t width = 0;   ///< cells along x
  std::uint32_t height = 0;  ///< cells along y
  double z_m = 0.0;          ///< of the floor, map frame
  /// Percent occupied, 0 … 100, or kUnknown. Rows along x, the row of the smallest y first: width x height cells.
  std::vector<std::int8_t> cells;
};

}  // namespace isobar
