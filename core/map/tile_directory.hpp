// SPDX-License-Identifier: BSD-3-Clause
// Finds the immutable tiles of a snapshot by their keys.
#pragma once

#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/map/tile_key.hpp"

namespace isobar {

/// Tiles of type `Tile`, which has a member `key`, in a table with open addressing.
template <typename Tile>
class TileDirectory {
 public:
  TileDirectory() = default;
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

  /// Null where there is no such tile.
  [[nodiscard]] const Tile* find(const TileKey& key) const {
    std::size_t slot = key.hash() & (slots_.size() - 1);
    while (slots_[slot].tile != nullptr && slots_[slot].key != key) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    return slots_[slot].tile;
  }

  [[nodiscard]] std::size_t size() const { return tiles_.size(); }

 private:
  struct Slot {
    TileKey key;
    const Tile* tile = nullptr;
  };
  std::vector<std::shared_ptr<const Tile>> tiles_;
  std::vector<Slot> slots_ = std::vector<Slot>(1);  // a power of two, at most half full
};

}  // namespace isobar
