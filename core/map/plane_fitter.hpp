// SPDX-License-Identifier: BSD-3-Clause
// The plane of a cell, from the smallest surface that is enough to the largest: the cell, its neighbours, a
// cube of 4 x 4 x 4 cells. A cube of 1 m gives far walls a normal, where the rings are farther apart than the
// cells.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/map/map_config.hpp"
#include "core/map/map_tile.hpp"
#include "core/map/plane_cell.hpp"

namespace isobar {

class PlaneFitter {
 public:
  /// Gives the tile of a key, or null.
  using FindTile = std::function<const MapTile*(const TileKey&)>;

  PlaneFitter(const MapConfig& config, FindTile find_tile);

  /// Fits the planes of the cells `waiting` of block `block` of `tile`. True if the block's planes changed.
  bool refit(const MapTile& tile, std::size_t block, const SlotSet& waiting);

 private:
  // A cell's own plane must be this much better than required, else its neighbours help.
  static constexpr float kOwnCellShare = 0.5F;

  // A block and those around it, each looked for when it is first asked for.
  class Surroundings;

  bool fit(Surroundings& around, const MapCell& cell, PackedPlane& plane) const;
  [[nodiscard]] Moments neighbourhood(Surroundings& around, const MapCell& centre) const;
  [[nodiscard]] Moments cube_around(const MapBlock& block, int slot) const;

  float cell_m_;
  PlaneCriteria criteria_;
  FindTile find_tile_;
  std::vector<PackedPlane> scratch_;
};

/// Calls `visit(slot)` for the members of `mask`, both sides, in the cube of 4 x 4 x 4 cells, aligned to its
/// block, that holds place `place`.
template <typename Visit>
void for_each_in_cube(const CellMask& mask, int place, Visit visit) {
  const CellIndex offset = offset_of(place);
  const CellIndex low(offset.x() & 4, offset.y() & 4, offset.z() & 4);
  const CellIndex high = low.array() + 3;
  for (int side = 0; side < kSides; ++side) {
    for_each_in_window(mask, side, low, high, visit);
  }
}

}  // namespace isobar
