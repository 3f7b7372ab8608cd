// SPDX-License-Identifier: BSD-3-Clause
// Nearest-neighbour search in one tile of the map. tile_index.cpp is the only file that names nanoflann.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace isobar {

/// Edge of a tile [m]. One tree a tile of this size was measured to be faster than one tree for all.
inline constexpr double kTileSizeM = 8.0;

/// Position of a tile on the grid of tiles.
struct TileKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  bool operator==(const TileKey&) const = default;

  [[nodiscard]] std::uint64_t hash() const {
    std::uint64_t h = static_cast<std::uint32_t>(x) * 0x9E3779B97F4A7C15ULL;
    h ^= (h >> 29) + static_cast<std::uint32_t>(y) * 0xBF58476D1CE4E5B9ULL;
    h ^= (h >> 31) + static_cast<std::uint32_t>(z) * 0x94D049BB133111EBULL;
    return h ^ (h >> 32);
  }
  /// Corner of the tile with the smallest coordinates, in the map frame [m].
  [[nodiscard]] Eigen::Vector3d origin_map() const { return Eigen::Vector3d(x, y, z) * kTileSizeM; }
};

/// The tile that holds a point of the map frame. |p_map| must be below 1e9 m.
inline TileKey tile_of(const Eigen::Vector3d& p_map) {
  return {static_cast<std::int32_t>(std::floor(p_map.x() / kTileSizeM)),
          static_cast<std::int32_t>(std::floor(p_map.y() / kTileSizeM)),
          static_cast<std::int32_t>(std::floor(p_map.z() / kTileSizeM))};
}

/// A plane of the map: a point on it relative to the tile's origin and its normal towards the observer.
struct TilePlane {
  Eigen::Vector3f q_tile;
  Eigen::Vector3f normal;
};

/// Immutable search structure over the planes of one tile.
class TileIndex {
 public:
  TileIndex(const TileKey& key, std::vector<TilePlane> planes);
  ~TileIndex();
  TileIndex(const TileIndex&) = delete;
  TileIndex& operator=(const TileIndex&) = delete;

  /// Index of the plane point nearest to `p_tile` that is closer than sqrt(squared_distance) and faces
  /// `viewpoint_tile` (both relative to the tile's origin); -1 if there is none. Lowers `squared_distance`.
  std::ptrdiff_t nearest(const Eigen::Vector3f& p_tile, const Eigen::Vector3f& viewpoint_tile,
                         float& squared_distance) const;

  [[nodiscard]] const TileKey& key() const { return key_; }
  [[nodiscard]] const std::vector<TilePlane>& planes() const { return planes_; }

 private:
  struct Tree;
  TileKey key_;
  std::vector<TilePlane> planes_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace isobar
