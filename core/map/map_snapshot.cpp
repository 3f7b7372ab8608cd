// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_snapshot.hpp"

#include <bit>
#include <utility>

namespace isobar {

MapSnapshot::MapSnapshot(std::vector<std::shared_ptr<const TileIndex>> tiles) : tiles_(std::move(tiles)) {
  std::erase_if(tiles_, [](const auto& tile) { return tile == nullptr || tile->planes().empty(); });
  slots_.resize(std::bit_ceil(tiles_.size() * 2 + 1));
  for (const auto& tile : tiles_) {
    plane_count_ += tile->planes().size();
    std::size_t slot = tile->key().hash() & (slots_.size() - 1);
    while (slots_[slot].tile != nullptr) {
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = {tile->key(), tile.get()};
  }
}

const TileIndex* MapSnapshot::find(const TileKey& key) const {
  std::size_t slot = key.hash() & (slots_.size() - 1);
  while (slots_[slot].tile != nullptr && slots_[slot].key != key) {
    slot = (slot + 1) & (slots_.size() - 1);
  }
  return slots_[slot].tile;
}

bool MapSnapshot::nearest(const Eigen::Vector3d& p_map, const Eigen::Vector3d& viewpoint_map,
                          double max_distance_m, MapMatch& match) const {
  if (empty()) {
    return false;
  }
  const TileKey first = tile_of(p_map.array() - max_distance_m);
  const TileKey last = tile_of(p_map.array() + max_distance_m);
  auto squared_distance = static_cast<float>(max_distance_m * max_distance_m);
  const TilePlane* best = nullptr;
  const TileIndex* best_tile = nullptr;
  for (std::int32_t x = first.x; x <= last.x; ++x) {
    for (std::int32_t y = first.y; y <= last.y; ++y) {
      for (std::int32_t z = first.z; z <= last.z; ++z) {
        const TileIndex* tile = find({x, y, z});
        if (tile == nullptr) {
          continue;
        }
        const Eigen::Vector3d origin = tile->key().origin_map();
        const std::ptrdiff_t index = tile->nearest((p_map - origin).cast<float>(),
                                                   (viewpoint_map - origin).cast<float>(), squared_distance);
        if (index >= 0) {
          best = &tile->planes()[static_cast<std::size_t>(index)];
          best_tile = tile;
        }
      }
    }
  }
  if (best == nullptr) {
    return false;
  }
  match.q_map = best_tile->key().origin_map() + best->q_tile.cast<double>();
  match.normal_map = best->normal;
  match.distance_m = std::sqrt(squared_distance);
  return true;
}

}  // namespace isobar
