// SPDX-License-Identifier: BSD-3-Clause
// Name of a tile of the map.
#pragma once

#include <cstdint>

namespace isobar {

/// Position of a tile on the grid of tiles.
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
};

}  // namespace isobar
