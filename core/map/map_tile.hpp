// SPDX-License-Identifier: BSD-3-Clause
// One tile of the map under construction, and the bytes that it is while it is out of memory.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/map/map_block.hpp"
#include "core/map/map_point.hpp"
#include "core/map/plane_block.hpp"

namespace isobar {

/// 4 x 4 x 4 blocks, made when something is seen in them.
class MapTile {
 public:
  explicit MapTile(const TileKey& key) : key_(key) {}

  [[nodiscard]] const TileKey& key() const { return key_; }
  [[nodiscard]] MapBlock* block(std::size_t index) const { return blocks_[index].get(); }
  MapBlock& block_or_add(std::size_t index) {
    if (blocks_[index] == nullptr) blocks_[index] = std::make_unique<MapBlock>();
    return *blocks_[index];
  }

  /// Makes planes() anew from those of the blocks.
  void publish();
  /// Planes as last published; null before.
  [[nodiscard]] const std::shared_ptr<const PlaneTile>& planes() const { return planes_; }

  /// Replaces `bytes` by all that the tile knows. The same tile gives the same bytes.
  void store(float cell_m, std::vector<std::byte>& bytes) const;
  /// The inverse of store(). False, and the tile untouched, where the bytes are not a tile of this key and
  /// this cell size.
  bool restore(std::span<const std::byte> bytes, float cell_m);

  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  TileKey key_;
  std::array<std::unique_ptr<MapBlock>, kBlocksPerTile> blocks_;
  std::shared_ptr<const PlaneTile> planes_;
};

/// Appends the points of a tile, in order of place: where a cell has a plane at most nine, on the plane; else
/// the centres of its occupied thirds.
void append_points(const MapTile& tile, float cell_m, std::vector<MapPoint>& points);

/// The same from the bytes of MapTile::store(). Returns false, and appends nothing, where they are not a
/// tile.
bool append_tile_points(std::span<const std::byte> bytes, std::vector<MapPoint>& points);

}  // namespace isobar
