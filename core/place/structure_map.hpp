// SPDX-License-Identifier: BSD-3-Clause
// What a map says about places: walls and ground in voxels, tile by tile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/map/map_point.hpp"
#include "core/map/tile_key.hpp"

namespace isobar {

/// What a voxel shows, as bits.
enum StructureKind : std::uint8_t {
  kWallStructure = 1,    ///< a surface that stands upright
  kGroundStructure = 2,  ///< a surface that the robot may stand on
  kOtherStructure = 4,   ///< points without a plane: vegetation, clutter, single rings
};

/// A voxel of kPlaceCellM per edge: floor(p_map / edge) per axis. 12 bytes.
struct StructureVoxel {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int16_t z = 0;
  std::uint8_t kinds = 0;  ///< StructureKind
};

/// Walls and ground of a map. About 12 bytes per 0.2 m voxel with points. Not thread-safe.
class StructureMap {
 public:
  struct Tile {
    std::vector<StructureVoxel> voxels;  ///< sorted, none twice
    StructureVoxel low;                  ///< least and greatest indices of the voxels
    StructureVoxel high;
  };

  /// Replaces the content of a tile by its points (MapTile::append_points()), all within 6 km of height 0; others are
  /// left out. No points: the tile is removed.
  void set_tile(const TileKey& key, std::span<const MapPoint> points);
  /// The same for points that have no tiles, such as those of a submap.
  void set_points(std::span<const MapPoint> points) { set_tile({}, points); }

  [[nodiscard]] const std::unordered_map<TileKey, Tile, TileKey::Hash>& tiles() const { return tiles_; }
  [[nodiscard]] std::size_t voxel_count() const;

 private:
  std::unordered_map<TileKey, Tile, TileKey::Hash> tiles_;
};

}  // namespace isobar
