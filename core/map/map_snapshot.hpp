// SPDX-License-Identifier: BSD-3-Clause
// An immutable view of the map, as the registration sees it. Unchanged tiles are shared between snapshots.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/map/map_point.hpp"
#include "core/map/tile_index.hpp"

namespace isobar {

/// Planes of all tiles around the robot. Any number of threads may read it at once.
class MapSnapshot {
 public:
  /// An empty map.
  MapSnapshot() = default;
  /// `tiles` may hold null pointers, which are skipped.
  explicit MapSnapshot(std::vector<std::shared_ptr<const TileIndex>> tiles);

  /// Nearest plane point within `max_distance_m` of `p_map` whose observed side faces `viewpoint_map`.
  /// False, and `match` untouched, where there is none. No allocation, no lock.
  bool nearest(const Eigen::Vector3d& p_map, const Eigen::Vector3d& viewpoint_map, double max_distance_m,
               MapMatch& match) const;

  [[nodiscard]] bool empty() const { return plane_count_ == 0; }
  /// Number of planes that can be matched.
  [[nodiscard]] std::size_t plane_count() const { return plane_count_; }
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }

 private:
  struct Slot {
    TileKey key;
    const TileIndex* tile = nullptr;
  };
  [[nodiscard]] const TileIndex* find(const TileKey& key) const;

  std::vector<std::shared_ptr<const TileIndex>> tiles_;
  std::vector<Slot> slots_;  // open addressing, a power of two, at most half full
  std::size_t plane_count_ = 0;
};

}  // namespace isobar
