// SPDX-License-Identifier: BSD-3-Clause
// Immutable hash table of the tiles of a snapshot.
#pragma once

#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/map/tile_key.hpp"

namespace isobar {

/// Hash table with open addressing and linear probing. `Tile` has a member `TileKey key`.
template <typename Tile>
class TileDirectory {
 public:
  /// `tiles`: no null pointers, no key twice.
  explicit TileDirectory(std::vector<std::shared_ptr<const Tile>> tiles) : tiles_(std::move(tiles)) {
    slots_.resize(std::bit_ceil(tiles_.size() * 2 + 1));
    for (const auto& tile : tiles_) {
      std::size_t slot = tile->key.hash() & (slots_.size() - 1);
      while (slots_[slot].tile != nullptr) {
        slot = (slot + 1) & (slots_.size() - 1);
      }
      slots_[slot] = {tile->key, tile.get()};
    }
  }

  /// Tile of a key; null if there is none.
  [[nodiscard]] const Tile* find(const TileKey& key) const {
    std::size_t slot = key.hash() & (slots_.size() - 1);
    while (slots_[slot].tile != nullptr && slots_[slot].key != key) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    return slots_[slot].tile;
  }

 private:
  struct Slot {
    TileKey key;
    const Tile* tile = nullptr;
  };
  std::vector<std::shared_ptr<const Tile>> tiles_;
  std::vector<Slot> slots_;  // size is a power of two, at most half of the slots are used
};

}  // namespace isobar
