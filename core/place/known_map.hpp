// SPDX-License-Identifier: BSD-3-Clause
// A map in which places are searched: all of it, not only what is around the robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/map/map_point.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/map/plane_block.hpp"
#include "core/place/structure_map.hpp"

namespace isobar {

/// Walls, ground and planes of a map. Use: add_tile() for each stored tile, then finish(). Memory: about 30 bytes a cell of
/// the map. After finish() immutable: any number of threads may read it.
class KnownMap {
 public:
  /// `cell_m`: edge of the map's cells. `session`: number of the map frame.
  explicit KnownMap(float cell_m, std::uint32_t session = 1);

  /// Of points and snapshot of a map in memory, such as a LocalMap's. Finished.
  KnownMap(std::span<const MapPoint> points, std::shared_ptr<const MapSnapshot> snapshot);

  /// Adds a tile as MapTile::store() wrote it. False, and no change, if the bytes are not those of this tile. O(points).
  bool add_tile(const TileKey& key, std::span<const std::byte> bytes);
  /// Makes the snapshot of all tiles so far.
  void finish();

  [[nodiscard]] const StructureMap& structure() const { return structure_; }
  /// Never null after finish().
  [[nodiscard]] const std::shared_ptr<const MapSnapshot>& snapshot() const { return snapshot_; }

 private:
  float cell_m_;
  std::uint32_t session_;
  StructureMap structure_;
  std::vector<std::shared_ptr<const PlaneTile>> planes_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::vector<MapPoint> points_;  // scratch
};

}  // namespace isobar
