// SPDX-License-Identifier: BSD-3-Clause
// What leaves the map with the distance, and how it comes back: the part of LocalMap that knows the shelf.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/map/local_map.hpp"

namespace isobar {

namespace {

// Tiles that come back from the shelf with one update: so many are read in a few milliseconds.
constexpr std::size_t kTilesPerUpdate = 8;

}  // namespace

// The tile that points go to, back from the shelf if it is there. Null where this update has brought back
// enough: the next scan sees the place too, and a tile made anew would hide the old one.
LocalMap::Tile* LocalMap::tile_for_points(const TileKey& key) {
  if (const auto found = tiles_.find(key); found != tiles_.end()) {
    return found->second.get();
  }
  if (shelf_ != nullptr && shelf_->contains(key)) {
    if (restored_ >= kTilesPerUpdate) {
      return nullptr;
    }
    return restore(key);
  }
  return tiles_.emplace(key, std::make_unique<Tile>(key)).first->second.get();
}

// Takes a tile from the shelf; an empty one where it is damaged.
LocalMap::Tile* LocalMap::restore(const TileKey& key) {
  ++restored_;
  Tile* tile = tiles_.emplace(key, std::make_unique<Tile>(key)).first->second.get();
  const bool good = shelf_->take(key, bytes_) && tile->cells.restore(bytes_, cell_m_);
  lost_tile_count_ += good ? 0 : 1;
  return tile;
}

// Puts a copy of a tile on the shelf.
void LocalMap::shelve(const TileKey& key) {
  tiles_.at(key)->cells.store(cell_m_, bytes_);
  lost_tile_count_ += shelf_->put(key, bytes_) ? 0 : 1;
}

void LocalMap::evict(const Eigen::Vector3d& p_map_base) {
  std::vector<TileKey> far;
  for (const auto& [key, tile] : tiles_) {
    if ((centre_of(key, cell_m_) - p_map_base).norm() > config_.radius_m + tile_m(cell_m_)) {
      far.push_back(key);
    }
  }
  // In order of place, since the order of a hash table is nobody's promise.
  std::sort(far.begin(), far.end());
  for (const TileKey& key : far) {
    if (shelf_ != nullptr) shelve(key);
    tiles_.erase(key);
  }
}

void LocalMap::look_for_stored(const Eigen::Vector3d& p_map_base) {
  stored_.clear();
  if (shelf_ == nullptr) {
    return;
  }
  const auto reach = static_cast<std::int32_t>(std::ceil(config_.radius_m / tile_m(cell_m_)));
  const CellIndex robot = LocalFrame(p_map_base, cell_m_).origin_cell;
  const TileKey at = tile_of(robot);
  for (std::int32_t x = at.x - reach; x <= at.x + reach; ++x) {
    for (std::int32_t y = at.y - reach; y <= at.y + reach; ++y) {
      for (std::int32_t z = at.z - reach; z <= at.z + reach; ++z) {
        const TileKey key{x, y, z};
        if ((centre_of(key, cell_m_) - p_map_base).norm() <= config_.radius_m && !tiles_.contains(key) &&
            shelf_->contains(key)) {
          stored_.push_back(key);
        }
      }
    }
  }
  const auto farther = [&](const TileKey& a, const TileKey& b) {
    const double da = (centre_of(a, cell_m_) - p_map_base).squaredNorm();
    const double db = (centre_of(b, cell_m_) - p_map_base).squaredNorm();
    return da > db || (da == db && a < b);
  };
  std::sort(stored_.begin(), stored_.end(), farther);
}

void LocalMap::bring_back_stored() {
  restored_ = 0;
  while (restored_ < kTilesPerUpdate && !stored_.empty()) {
    const TileKey key = stored_.back();
    stored_.pop_back();
    if (!tiles_.contains(key)) {
      restore(key);
    }
  }
}

}  // namespace isobar
