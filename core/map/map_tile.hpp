// SPDX-License-Identifier: BSD-3-Clause
// Mutable tile of the map, and its serialised form for the tile storage.
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

/// 4 x 4 x 4 blocks, created on demand.
class MapTile {
 public:
  explicit MapTile(const TileKey& key) : key_(key) {}

  [[nodiscard]] const TileKey& key() const { return key_; }
  /// Block `index` (0 … 63, see block_of()); null if nothing was seen there.
  [[nodiscard]] MapBlock* block(std::size_t index) const { return blocks_[index].get(); }
  MapBlock& block_or_add(std::size_t index) {
    if (blocks_[index] == nullptr) blocks_[index] = std::make_unique<MapBlock>();
    return *blocks_[index];
  }

  /// Rebuilds planes() from the planes of the blocks.
  void publish();
  /// Planes of the last publish(), immutable; null before the first.
  [[nodiscard]] const std::shared_ptr<const PlaneTile>& planes() const { return planes_; }

  /// Serialises the tile to `bytes`, whose former content is dropped. Equal tiles give equal bytes.
  void store(float cell_m, std::vector<std::byte>& bytes) const;
  /// Inverse of store(). Returns false and leaves the tile unchanged if the bytes are not those of a tile
  /// with this key and cell size.
  bool restore(std::span<const std::byte> bytes, float cell_m);

  /// Appends the points of the tile, sorted by block and cell. A cell with a plane gives up to nine points on
  /// the plane; a cell without one gives the centres of its occupied sub-cells (thirds of the edge).
  void append_points(float cell_m, std::vector<MapPoint>& points) const;
  /// append_points() of a tile serialised by store(). Returns false and appends nothing if the bytes are not
  /// a tile.
  static bool append_stored_points(std::span<const std::byte> bytes, std::vector<MapPoint>& points);

  [[nodiscard]] std::size_t cell_count() const;

 private:
  TileKey key_;
  std::array<std::unique_ptr<MapBlock>, kBlocksPerTile> blocks_;
  std::shared_ptr<const PlaneTile> planes_;
};

}  // namespace isobar
