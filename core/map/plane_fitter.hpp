// SPDX-License-Identifier: BSD-3-Clause
// Fits the plane of a cell to the smallest neighbourhood that has a good one: the cell alone (unless a face of it cuts the
// noise of the surface in two), the cell and its neighbours, or a cube of 4 x 4 x 4 cells. The cube, about 1 m wide, gives
// normals to far walls, where lidar rings are farther apart than cells.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/map/map_config.hpp"
#include "core/map/map_tile.hpp"
#include "core/map/plane_cell.hpp"

namespace isobar {

/// Refits planes of the map. One thread.
class PlaneFitter {
 public:
  /// Returns the tile of a key, or null.
  using FindTile = std::function<const MapTile*(const TileKey&)>;

  PlaneFitter(const MapConfig& config, FindTile find_tile);

  /// Refits the cells `waiting` of block `block_index` (0 … 63) of `tile`. True if a plane of the block
  /// changed.
  bool refit(const MapTile& tile, std::size_t block_index, const SlotSet& waiting);

 private:
  // Factor on the allowed deviation of the normal for a fit to the cell's own points: it must be twice as
  // good as required, or else the neighbours' points are used.
  static constexpr float kOwnCellDeviationFactor = 0.5F;

  // A block and its 26 neighbours, looked up on first use.
  class Surroundings;

  [[nodiscard]] bool cut_off(const Plane& plane) const;
  bool fit(Surroundings& around, const MapCell& cell, PackedPlane& packed) const;
  [[nodiscard]] Moments neighbourhood(Surroundings& around, const MapCell& centre) const;
  [[nodiscard]] Moments cube_around(const MapBlock& block, int slot) const;

  float cell_m_;
  PlaneCriteria criteria_;
  FindTile find_tile_;
  std::vector<PackedPlane> scratch_;
};

}  // namespace isobar
