// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

std::int8_t OccupancyGrid::at(const Eigen::Vector2d& p_map) const {
  const Eigen::Array2d cell = ((p_map - origin_m) / resolution_m).array().floor();
  const bool inside =
      (cell >= 0.0).all() && cell.x() < static_cast<double>(width) && cell.y() < static_cast<double>(height);
  return inside ? cells[index(static_cast<int>(cell.x()), static_cast<int>(cell.y()))] : kCellUnknown;
}

OccupancyGrid cropped(const OccupancyGrid& grid, int margin) {
  Eigen::Vector2i low(grid.width, grid.height);
  Eigen::Vector2i high(-1, -1);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (grid.cells[grid.index(x, y)] == kCellUnknown) continue;
      low = low.cwiseMin(Eigen::Vector2i(x, y));
      high = high.cwiseMax(Eigen::Vector2i(x, y));
    }
  }
  OccupancyGrid part;
  part.resolution_m = grid.resolution_m;
  part.origin_m = grid.origin_m;
  part.height_m = grid.height_m;
  if (high.x() < 0) return part;
  low = low.array() - margin;
  high = high.array() + margin;
  part.origin_m += low.cast<double>() * grid.resolution_m;
  part.width = high.x() - low.x() + 1;
  part.height = high.y() - low.y() + 1;
  part.cells.assign(static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height),
                    kCellUnknown);
  for (int y = std::max(low.y(), 0); y <= std::min(high.y(), grid.height - 1); ++y) {
    const int first = std::max(low.x(), 0);
    const int last = std::min(high.x(), grid.width - 1);
    const auto from = grid.cells.begin() + static_cast<std::ptrdiff_t>(grid.index(first, y));
    std::copy(from, from + (last - first + 1),
              part.cells.begin() + static_cast<std::ptrdiff_t>(part.index(first - low.x(), y - low.y())));
  }
  return part;
}

}  // namespace isobar
