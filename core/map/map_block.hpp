// SPDX-License-Identifier: BSD-3-Clause
// Mutable block of the map: up to 8 x 8 x 8 cells with the moments of their points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/map/cell_mask.hpp"
#include "core/map/cell_moments.hpp"
#include "core/map/plane_block.hpp"

namespace isobar {

/// Points of one side of a cell. Its plane, if any, is in the block's PlaneBlock. 44 bytes.
struct MapCell {
  CellMoments moments;
  std::uint32_t occupied_sub_cells = 0;  ///< bitmap of the 3 x 3 x 3 sub-cells with points, x fastest
  std::uint16_t slot = 0;                ///< in the block, see SlotSet
  std::array<std::int8_t, 3> facing{};   ///< unit vector * 127: normal of the plane; direction to the first
                                         ///< observer as long as there is no plane
  std::uint8_t fitted_count : 7 = 0;     ///< moments.count() at the last plane fit
  std::uint8_t has_plane : 1 = 0;        ///< result of the last plane fit
  std::uint8_t seen_through = 0;         ///< rays that passed through, minus observations; never below 0
  std::uint8_t intensity = 0;            ///< mean reflectivity of the points

  [[nodiscard]] Eigen::Vector3f facing_vector() const {
    return Eigen::Vector3f(facing[0], facing[1], facing[2]) * (1.0F / 127.0F);
  }
  void set_facing(const Eigen::Vector3f& unit);
};
static_assert(sizeof(MapCell) == 44);

/// Cells of a block, and the immutable planes of the last refit.
class MapBlock {
 public:
  /// A point of a scan, relative to its cell.
  struct Observation {
    Eigen::Vector3f fraction;  ///< position in the cell, 0 … 1 per axis
    Eigen::Vector3f toward;    ///< unit vector to the lidar
    std::uint8_t intensity = 0;
    int freeze = 0;  ///< see MapConfig::freeze_observations
  };
  /// Adds a point to the cell at `place` (0 … 511), on the side that the point was seen from. Returns the
  /// slot if its plane is due for a refit, else kNoSlot.
  int observe(int place, const Observation& observation);
  static constexpr int kNoSlot = -1;

  /// Two prefetches for observe(): first the mask, then (once that is in the cache) the cell.
  void prefetch_mask(int place) const {
    mask_.prefetch(place);
    __builtin_prefetch(&cells_);
  }
  void prefetch_cell(int place) const {
    const std::size_t at = mask_.rank(place);
    if (at >= cells_.size()) return;
    const char* bytes = reinterpret_cast<const char*>(&cells_[at]);
    __builtin_prefetch(bytes);  // 44 bytes straddle two cache lines more often than not
    __builtin_prefetch(bytes + sizeof(MapCell) - 1);
  }

  /// Cell of a slot; null if it has no points.
  [[nodiscard]] const MapCell* find(int slot) const {
    return mask_.has(slot) ? &cells_[mask_.rank(slot)] : nullptr;
  }
  /// Sorted by slot.
  [[nodiscard]] const std::vector<MapCell>& cells() const { return cells_; }
  [[nodiscard]] std::vector<MapCell>& cells() { return cells_; }
  [[nodiscard]] const CellMask& mask() const { return mask_; }

  /// Plane of a slot as of the last refit; null if it has none.
  [[nodiscard]] const PackedPlane* plane_at(int slot) const {
    return planes_ ? planes_->find(slot) : nullptr;
  }

  /// Removes the cells whose seen_through exceeds `limit`; returns their number.
  std::size_t remove_seen_through(std::uint8_t limit);

  /// Fits the planes of the cells in `waiting` by `bool fit(const MapCell&, PackedPlane&)`, which returns
  /// false if a cell has no plane. Drops the planes of removed cells. Replaces planes() and returns true if
  /// any plane changed. `scratch` is overwritten.
  template <typename Fit>
  bool refit(const SlotSet& waiting, Fit fit, std::vector<PackedPlane>& scratch);

  /// For the owner: index of the block in the owner's list of blocks to refit, or kNotListed.
  std::int32_t list_index = kNotListed;
  static constexpr std::int32_t kNotListed = -1;

  /// Planes of the last refit, immutable; null if no cell has a plane.
  [[nodiscard]] const std::shared_ptr<const PlaneBlock>& planes() const { return planes_; }

  /// Rebuilds the block from stored cells and planes, both sorted by slot.
  void restore(std::vector<MapCell> cells, std::shared_ptr<const PlaneBlock> planes);

 private:
  MapCell& find_or_add(int slot);

  CellMask mask_;
  std::vector<MapCell> cells_;
  std::shared_ptr<const PlaneBlock> planes_;
};

// Merges the old planes with the cells that wait, word by word of the masks. Only waiting cells are read,
// since each costs a cache miss.
template <typename Fit>
bool MapBlock::refit(const SlotSet& waiting, Fit fit, std::vector<PackedPlane>& scratch) {
  scratch.clear();
  bool changed = false;
  CellMask mask;
  const PackedPlane* next_old = planes_ ? planes_->planes.data() : nullptr;
  for (std::size_t i = 0; i < CellMask::kWords; ++i) {
    const std::uint64_t had = planes_ ? planes_->mask.word(i) : 0;
    const std::uint64_t due = waiting.words[i] & mask_.word(i);
    std::uint64_t has = had & mask_.word(i);
    changed = changed || has != had;  // a cell with a plane was removed by remove_seen_through()
    for (std::uint64_t left = had | due; left != 0; left &= left - 1) {
      const std::uint64_t bit = left & -left;
      const PackedPlane* old = (had & bit) != 0 ? next_old++ : nullptr;
      PackedPlane plane;
      if ((due & bit) != 0) {
        MapCell& cell = cells_[mask_.rank(static_cast<int>(64 * i) + std::countr_zero(bit))];
        cell.fitted_count = static_cast<std::uint8_t>(cell.moments.count()) & 0x7FU;
        const bool fitted = fit(std::as_const(cell), plane);
        cell.has_plane = fitted ? 1 : 0;
        if (fitted) cell.set_facing(plane.unit_normal());
        changed = changed || fitted != (old != nullptr) || (fitted && plane != *old);
        has = fitted ? has | bit : has & ~bit;
      } else if (old != nullptr) {
        plane = *old;
      }
      if ((has & bit) != 0) scratch.push_back(plane);
    }
    mask.set_word(i, has);
  }
  if (changed) {
    mask.update_ranks();
    planes_ = scratch.empty() ? nullptr : std::make_shared<const PlaneBlock>(mask, scratch);
  }
  return changed;
}

}  // namespace isobar
