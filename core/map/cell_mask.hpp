// SPDX-License-Identifier: BSD-3-Clause
// Which cells of a block are taken, and where each stands in a dense list.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/map/grid.hpp"

namespace isobar {

/// Sides of a cell: a wall thinner than a cell has two.
inline constexpr int kSides = 2;

/// A set of slots 0 … 1023 of a block: side * 512 + place. 64 slots a word.
struct SlotSet {
  static constexpr int kSlots = kPlacesPerBlock * kSides;
  std::array<std::uint64_t, kSlots / 64> words{};

  void insert(int slot) {
    const auto at = static_cast<unsigned>(slot);
    words[at / 64] |= std::uint64_t{1} << at % 64;
  }
  friend bool operator==(const SlotSet&, const SlotSet&) = default;
};

/// The same with the number of members below each: finding a member's rank takes one popcount.
class CellMask {
 public:
  static constexpr int kSlots = SlotSet::kSlots;
  static constexpr std::size_t kWords = kSlots / 64;

  friend bool operator==(const CellMask&, const CellMask&) = default;

  [[nodiscard]] bool has(int slot) const { return (members_.words[index(slot)] >> bit(slot) & 1U) != 0; }

  /// Begins to fetch what has() and rank() of a slot read.
  void prefetch(int slot) const {
    __builtin_prefetch(&members_.words[index(slot)]);
    __builtin_prefetch(&ranks_[index(slot)]);
  }

  /// Number of members below `slot`: its index in a list of the members in order.
  [[nodiscard]] std::size_t rank(int slot) const {
    const std::uint64_t below = members_.words[index(slot)] & ((std::uint64_t{1} << bit(slot)) - 1);
    return ranks_[index(slot)] + static_cast<std::size_t>(std::popcount(below));
  }

  [[nodiscard]] std::size_t count() const {
    return ranks_[kWords - 1] + static_cast<std::size_t>(std::popcount(members_.words[kWords - 1]));
  }

  void insert(int slot) {
    members_.insert(slot);
    update_ranks();
  }
  void erase(int slot) {
    members_.words[index(slot)] &= ~(std::uint64_t{1} << bit(slot));
    update_ranks();
  }

  /// As insert(), but ranks are wrong until count_ranks().
  void mark(int slot) { members_.insert(slot); }
  void count_ranks() { update_ranks(); }

  /// Members of layer z (0 … 7) of a side: bit y * 8 + x.
  [[nodiscard]] std::uint64_t layer(int side, int z) const {
    const int at = side * kBlockCells + z;
    return members_.words[static_cast<std::size_t>(at)];
  }

  /// The slots 64 i … 64 i + 63 as bits. Ranks are wrong after set_word() until count_ranks().
  [[nodiscard]] std::uint64_t word(std::size_t i) const { return members_.words[i]; }
  void set_word(std::size_t i, std::uint64_t members) { members_.words[i] = members; }

 private:
  [[nodiscard]] static std::size_t index(int slot) { return static_cast<std::size_t>(slot) / 64; }
  [[nodiscard]] static unsigned bit(int slot) { return static_cast<unsigned>(slot) % 64; }

  void update_ranks() {
    std::uint16_t sum = 0;
    for (std::size_t i = 0; i < kWords; ++i) {
      ranks_[i] = sum;
      sum = static_cast<std::uint16_t>(sum + std::popcount(members_.words[i]));
    }
  }

  SlotSet members_;
  std::array<std::uint16_t, kWords> ranks_{};
};

/// Bits of the cells x0 … x1, y0 … y1 (0 … 7, both ends included) in a layer.
[[nodiscard]] constexpr std::uint64_t layer_window(int x0, int x1, int y0, int y1) {
  const std::uint64_t row = (std::uint64_t{0xFF} >> static_cast<unsigned>(7 - (x1 - x0)))
                            << static_cast<unsigned>(x0);
  // The row at each y0 … y1: a one at the start of each, times the row.
  constexpr std::uint64_t kStarts = 0x0101010101010101;
  const std::uint64_t starts = (kStarts >> static_cast<unsigned>(8 * (7 - (y1 - y0))))
                               << static_cast<unsigned>(8 * y0);
  return starts * row;
}

/// Calls `visit(slot)` for each member of one side whose place is within `low` … `high` (0 … 7 an axis, both
/// included).
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

/// Calls `visit(first, low, high)` for each block that the cells `first` … `last` touch: its first cell, and
/// the window of them in it.
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
