// SPDX-License-Identifier: BSD-3-Clause
// A block of the map under construction: 8 x 8 x 8 cells with the moments of their points.
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

/// A cell of the grid, or one side of it. Its plane is in the block's PlaneBlock. 44 bytes.
struct MapCell {
  CellMoments moments;
  std::uint32_t occupied_sub_cells = 0;  ///< one bit each of 3 x 3 x 3, x fastest
  std::uint16_t slot = 0;                ///< in the block, see CellMask
  std::array<std::int8_t, 3> facing{};   ///< its plane's normal, before there is one the way to its first
                                         ///< observer; unit, times 127
  std::uint8_t fitted_count : 7 = 0;     ///< moments.count() when a plane was last looked for
  std::uint8_t has_plane : 1 = 0;        ///< as of the last look
  std::uint8_t seen_through = 0;         ///< rays that passed, less observations
  std::uint8_t intensity = 0;            ///< mean of the points' reflectivity

  [[nodiscard]] Eigen::Vector3f facing_vector() const {
    return Eigen::Vector3f(facing[0], facing[1], facing[2]) * (1.0F / 127.0F);
  }
  void set_facing(const Eigen::Vector3f& unit);
};
static_assert(sizeof(MapCell) == 44);

/// Cells of a block in order of their slots, and their planes as last published.
class MapBlock {
 public:
  /// What an observation was to a cell.
  struct Observation {
    Eigen::Vector3f fraction;  ///< place in the cell, 0 … 1
    Eigen::Vector3f toward;    ///< unit direction to the sensor
    std::uint8_t intensity = 0;
    int freeze = 0;  ///< see MapConfig::freeze_observations
  };
  /// Observes a point in place `place` (0 … 511). Returns the slot whose plane should be fitted for it, or
  /// kNoSlot.
  int observe(int place, const Observation& observation);
  static constexpr int kNoSlot = -1;

  /// Begin to fetch from memory: what find() of a place reads first, then its cell.
  void prefetch_mask(int place) const {
    mask_.prefetch(place);
    __builtin_prefetch(&cells_);
  }
  void prefetch_cell(int place) const {
    const std::size_t at = mask_.rank(place);
    if (at >= cells_.size()) return;
    const char* bytes = reinterpret_cast<const char*>(&cells_[at]);
    __builtin_prefetch(bytes);  // a cell lies in two lines of the cache more often than in one
    __builtin_prefetch(bytes + sizeof(MapCell) - 1);
  }

  [[nodiscard]] const MapCell* find(int slot) const {
    return mask_.has(slot) ? &cells_[mask_.rank(slot)] : nullptr;
  }
  [[nodiscard]] const std::vector<MapCell>& cells() const { return cells_; }
  [[nodiscard]] std::vector<MapCell>& cells() { return cells_; }
  [[nodiscard]] const CellMask& mask() const { return mask_; }

  /// The plane of a slot as last fitted; null if it has none.
  [[nodiscard]] const PackedPlane* plane_at(int slot) const {
    return planes_ ? planes_->find(slot) : nullptr;
  }

  /// Takes out cells whose seen_through is above `limit`; returns how many.
  std::size_t remove_seen_through(std::uint8_t limit);

  /// Asks `fit(cell, plane)` for the planes of the cells in `waiting`, false where there is none, and makes
  /// planes() anew if they are others than before. Returns true if so. `scratch` is overwritten.
  template <typename Fit>
  bool refit(const SlotSet& waiting, Fit fit, std::vector<PackedPlane>& scratch);

  /// Its owner's: where the block stands in a list of those to refit, kNotListed where it does not.
  std::int32_t list_index = kNotListed;
  static constexpr std::int32_t kNotListed = -1;

  /// Immutable; null where no cell has a plane.
  [[nodiscard]] const std::shared_ptr<const PlaneBlock>& planes() const { return planes_; }

  /// Puts a block together from stored cells and planes, both in order of their slots.
  void restore(std::vector<MapCell> cells, std::shared_ptr<const PlaneBlock> planes);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  MapCell& find_or_add(int slot);

  CellMask mask_;
  std::vector<MapCell> cells_;
  std::shared_ptr<const PlaneBlock> planes_;
};

// Cells that do not wait keep their planes and are not even read: they would come from far away in memory.
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
    changed = changed || has != had;  // the cell was seen through
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
    mask.count_ranks();
    planes_ = scratch.empty() ? nullptr : std::make_shared<const PlaneBlock>(mask, scratch);
  }
  return changed;
}

}  // namespace isobar
