// SPDX-License-Identifier: BSD-3-Clause
// Bitmap of the occupied cells of a block, with each cell's index in a dense array.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/map/grid.hpp"

namespace isobar {

/// Surfaces stored per cell: both sides of a wall that is thinner than the cell.
inline constexpr int kSides = 2;

/// Bitmap of slots of a block. Slot = side * 512 + place, 0 … 1023: side 0 … 1, place 0 … 511 (place_of()).
struct SlotSet {
  static constexpr int kSlots = kPlacesPerBlock * kSides;
  /// Bit s % 64 of word s / 64 is slot s.
  std::array<std::uint64_t, kSlots / 64> words{};

  void insert(int slot) {
    const auto at = static_cast<unsigned>(slot);
    words[at / 64] |= std::uint64_t{1} << at % 64;
  }
};

/// SlotSet with a prefix sum of members per word, so that a slot's rank costs one popcount.
class CellMask {
 public:
  static constexpr int kSlots = SlotSet::kSlots;
  static constexpr std::size_t kWords = kSlots / 64;

  [[nodiscard]] bool has(int slot) const { return (members_.words[index(slot)] >> bit(slot) & 1U) != 0; }

  /// Prefetches the words that has() and rank() of this slot read.
  void prefetch(int slot) const {
    __builtin_prefetch(&members_.words[index(slot)]);
    __builtin_prefetch(&ranks_[index(slot)]);
  }

  /// Number of members below `slot`: the index of a member in an array sorted by slot.
  [[nodiscard]] std::size_t rank(int slot) const {
    const std::uint64_t below = members_.words[index(slot)] & ((std::uint64_t{1} << bit(slot)) - 1);
    return ranks_[index(slot)] + static_cast<std::size_t>(std::popcount(below));
  }

  void insert(int slot) {
    members_.insert(slot);
    update_ranks();
  }
  void erase(int slot) {
    members_.words[index(slot)] &= ~(std::uint64_t{1} << bit(slot));
    update_ranks();
  }

  /// Insertion in bulk: mark() each slot, then call update_ranks() once; rank() is wrong in between.
  void mark(int slot) { members_.insert(slot); }
  void update_ranks() {
    std::uint16_t sum = 0;
    for (std::size_t i = 0; i < kWords; ++i) {
      ranks_[i] = sum;
      sum = static_cast<std::uint16_t>(sum + std::popcount(members_.words[i]));
    }
  }

  /// Members of one side with z = 0 … 7 (in cells from the block's corner): cell (x, y) is bit y * 8 + x.
  [[nodiscard]] std::uint64_t layer(int side, int z) const {
    const int at = side * kBlockCells + z;
    return members_.words[static_cast<std::size_t>(at)];
  }

  /// Slots 64 i … 64 i + 63 as bits. After set_word(), rank() is wrong until update_ranks().
  [[nodiscard]] std::uint64_t word(std::size_t i) const { return members_.words[i]; }
  void set_word(std::size_t i, std::uint64_t members) { members_.words[i] = members; }

 private:
  [[nodiscard]] static std::size_t index(int slot) { return static_cast<std::size_t>(slot) / 64; }
  [[nodiscard]] static unsigned bit(int slot) { return static_cast<unsigned>(slot) % 64; }

  SlotSet members_;
  std::array<std::uint16_t, kWords> ranks_{};  // number of members in all earlier words
};

/// Bit mask of the cells x0 … x1, y0 … y1 (0 … 7, inclusive) of a layer; bits as in CellMask::layer().
[[nodiscard]] constexpr std::uint64_t layer_window(int x0, int x1, int y0, int y1) {
  const std::uint64_t row = (std::uint64_t{0xFF} >> static_cast<unsigned>(7 - (x1 - x0)))
                            << static_cast<unsigned>(x0);
  // Copy of the row at each y0 … y1: multiply it by a mask with a one at the start of each of these rows.
  constexpr std::uint64_t kStarts = 0x0101010101010101;
  const std::uint64_t starts = (kStarts >> static_cast<unsigned>(8 * (7 - (y1 - y0))))
                               << static_cast<unsigned>(8 * y0);
  return starts * row;
}

/// Calls `visit(slot)` for each member of one side within the cells `low` … `high` of the block (0 … 7 per
/// axis, inclusive), in order of slots.
template <typename Visit>
void for_each_in_window(const CellMask& mask, int side, const CellIndex& low, const CellIndex& high,
                        Visit visit) {
  const std::uint64_t window = layer_window(low.x(), high.x(), low.y(), high.y());
  for (int z = low.z(); z <= high.z(); ++z) {
    std::uint64_t members = mask.layer(side, z) & window;
    while (members != 0) {
      visit((side * kBlockCells + z) * 64 + std::countr_zero(members));
      members &= members - 1;
    }
  }
}

/// Calls `visit(slot)` for the members of both sides in one of the eight cubes of 4 x 4 x 4 cells of the
/// block: the one that holds `place` (0 … 511).
template <typename Visit>
void for_each_in_cube(const CellMask& mask, int place, Visit visit) {
  const CellIndex offset = offset_of(place);
  const CellIndex low(offset.x() & 4, offset.y() & 4, offset.z() & 4);
  const CellIndex high = low.array() + 3;
  for (int side = 0; side < kSides; ++side) {
    for_each_in_window(mask, side, low, high, visit);
  }
}

/// Calls `visit(block, low, high)` for each block that intersects the box of cells `first` … `last`
/// (inclusive). `block`: first cell of the block; `low` … `high`: the box within the block, 0 … 7 per axis.
template <typename Visit>
void for_each_block(const CellIndex& first, const CellIndex& last, Visit visit) {
  for (int z = first.z() >> 3; z <= last.z() >> 3; ++z) {
    for (int y = first.y() >> 3; y <= last.y() >> 3; ++y) {
      for (int x = first.x() >> 3; x <= last.x() >> 3; ++x) {
        const CellIndex block = CellIndex(x, y, z) * kBlockCells;
        visit(block, (first - block).cwiseMax(0).eval(), (last - block).cwiseMin(kBlockCells - 1).eval());
      }
    }
  }
}

}  // namespace isobar
