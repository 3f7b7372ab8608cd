// SPDX-License-Identifier: BSD-3-Clause
// The plane of a cell, from the smallest surface that is enough to the largest: the cell, its neighbours, a
// cube of 4 x 4 x 4 cells. A cube of 1 m gives far walls a normal, where the rings are farther apart than the
// cells.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/map/map_config.hpp"
#include "core/map/map_tile.hpp"
#include "core/map/plane_cell.hpp"

namespace isobar {

class PlaneFitter {
 public:
  /// Gives the tile of a key, or null.
  using FindTile = std::function<const MapTile*(const TileKey&)>;

  PlaneFitter(const MapConfig& config, FindTile find_tile);

  /// Fits the plane of cell `slot` of block `block` of `tile`. False where there is none.
  bool fit(const MapTile& tile, std::size_t block, int slot, PackedPlane& plane) const;

 private:
  // A cell's own plane must be this much better than required, else its neighbours help.
  static constexpr float kOwnCellShare = 0.5F;

  [[nodiscard]] Moments neighbourhood(const MapTile& tile, const CellIndex& at, const MapCell& centre) const;
  [[nodiscard]] Moments cube_around(const MapBlock& block, int slot) const;

  float cell_m_;
  PlaneCriteria criteria_;
  FindTile find_tile_;
};

/// Cells of the cube of 4 x 4 x 4, aligned to its block, that holds place `place`, both sides: calls
/// `visit(slot)` for the members of `mask`.
template <typename Visit>
void for_each_in_cube(const CellMask& mask, int place, Visit visit) {
  const CellIndex offset = offset_of(place);
  const CellIndex low(offset.x() & 4, offset.y() & 4, offset.z() & 4);
  const std::uint64_t window = layer_window(low.x(), low.x() + 3, low.y(), low.y() + 3);
  for (int side = 0; side < kSides; ++side) {
    for (int z = low.z(); z < low.z() + 4; ++z) {
      std::uint64_t members = mask.layer(side, z) & window;
      while (members != 0) {
        visit((side * kBlockCells + z) * 64 + std::countr_zero(members));
        members &= members - 1;
      }
    }
  }
}

}  // namespace isobar
