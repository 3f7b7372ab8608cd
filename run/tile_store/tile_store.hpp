// SPDX-License-Identifier: BSD-3-Clause
// A shelf whose content can be listed, and the one that keeps it in memory.
#pragma once

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "core/map/tile_shelf.hpp"
#include "run/tile_store/tile_record.hpp"

namespace isobar {

/// A shelf that knows what is on it.
class TileStore : public TileShelf {
 public:
  /// The keys of all tiles, sorted by x, y, z, so that equal content is listed equally.
  [[nodiscard]] virtual std::vector<TileKey> keys() const = 0;
};

/// The keys of a hash table of tiles, sorted.
template <typename Table>
std::vector<TileKey> sorted_keys(const Table& table) {
  std::vector<TileKey> keys;
  keys.reserve(table.size());
  for (const auto& entry : table) keys.push_back(entry.first);
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Keeps everything, for tests.
class MemoryTileStore : public TileStore {
 public:
  bool put(const TileKey& key, std::span<const std::byte> bytes) override {
    tiles_[key].assign(bytes.begin(), bytes.end());
    return true;
  }
  bool take(const TileKey& key, std::vector<std::byte>& bytes) override {
    const auto found = tiles_.find(key);
    bytes.clear();
    if (found != tiles_.end()) bytes = found->second;
    return found != tiles_.end();
  }
  [[nodiscard]] bool contains(const TileKey& key) const override { return tiles_.contains(key); }
  [[nodiscard]] std::vector<TileKey> keys() const override { return sorted_keys(tiles_); }

 private:
  std::unordered_map<TileKey, std::vector<std::byte>, TileKeyHash> tiles_;
};

}  // namespace isobar
