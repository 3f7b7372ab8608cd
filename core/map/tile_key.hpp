// SPDX-License-Identifier: BSD-3-Clause
// Key of a tile of the map.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isobar {

/// Index of a tile on the grid of tiles: floor(p_map / edge of a tile) per axis.
struct TileKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  auto operator<=>(const TileKey&) const =
      default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 is wrong here

  [[nodiscard]] std::uint64_t hash() const {
    std::uint64_t h = static_cast<std::uint32_t>(x) * 0x9E3779B97F4A7C15ULL;
    h ^= (h >> 29) + static_cast<std::uint32_t>(y) * 0xBF58476D1CE4E5B9ULL;
    h ^= (h >> 31) + static_cast<std::uint32_t>(z) * 0x94D049BB133111EBULL;
    return h ^ (h >> 32);
  }

  /// Hash function for std::unordered_map.
  struct Hash {
    std::size_t operator()(const TileKey& key) const { return key.hash(); }
  };

  /// Keys of a hash table of tiles, sorted by x, y, z: the order of iteration of the table is unspecified.
  template <typename Table>
  [[nodiscard]] static std::vector<TileKey> sorted(const Table& table) {
    std::vector<TileKey> keys;
    keys.reserve(table.size());
    for (const auto& entry : table) keys.push_back(entry.first);
    std::sort(keys.begin(), keys.end());
    return keys;
  }
};

}  // namespace isobar
