// SPDX-License-Identifier: BSD-3-Clause
// The part of LocalMap that moves tiles between memory and the tile storage.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/map/local_map.hpp"

namespace isobar {

namespace {

// Maximum number of tiles that one update reads from the storage: it takes a few milliseconds.
constexpr std::size_t kTilesPerUpdate = 8;

// Maximum number of tiles that are read before the first scan: about a second.
constexpr std::size_t kTilesAtStart = 600;

}  // namespace

// Tile that a point is added to, read from the storage if it is there. Null if this update has read its
// maximum: the next scan sees the place as well, whereas a new empty tile would replace the stored one.
LocalMap::Tile* LocalMap::tile_for_points(const TileKey& key) {
  if (const auto found = tiles_.find(key); found != tiles_.end()) {
    return found->second.get();
  }
  if (storage_ != nullptr && storage_->contains(key)) {
    if (restored_ >= kTilesPerUpdate) {
      return nullptr;
    }
    return restore(key);
  }
  return tiles_.emplace(key, std::make_unique<Tile>(key)).first->second.get();
}

// Reads a tile from the storage; the tile is empty if it is damaged.
LocalMap::Tile* LocalMap::restore(const TileKey& key) {
  ++restored_;
  Tile* tile = tiles_.emplace(key, std::make_unique<Tile>(key)).first->second.get();
  tile->unstored = !(storage_->take(key, bytes_) && tile->cells.restore(bytes_, cell_m_));
  return tile;
}

// False if the disk refuses: the tile stays unstored.
bool LocalMap::store(const TileKey& key) {
  Tile& tile = *tiles_.at(key);
  tile.cells.store(cell_m_, bytes_);
  const bool stored = storage_->put(key, bytes_);
  tile.unstored = tile.unstored && !stored;
  return stored;
}

void LocalMap::store_some() {
  if (storage_ == nullptr) {
    return;
  }
  if (sweep_.empty()) {
    for (const auto& [key, tile] : tiles_) {
      if (tile->unstored) sweep_.push_back(key);
    }
    sweep_share_ = (sweep_.size() + kSweepParts - 1) / kSweepParts;
  }
  for (std::size_t i = 0; i < sweep_share_ && !sweep_.empty(); ++i) {
    const TileKey key = sweep_.back();
    sweep_.pop_back();
    const auto found = tiles_.find(key);
    if (found == tiles_.end() || !found->second->unstored) continue;
    // A full disk refuses the others as well.
    if (!store(key)) sweep_.clear();
  }
}

void LocalMap::change_storage(TileStorage* storage) {
  storage_ = storage;
  for (auto& [key, tile] : tiles_) tile->unstored = true;
}

void LocalMap::load_around(const Eigen::Vector3d& p_map_base) {
  look_for_stored(p_map_base);
  for (std::size_t i = 0; i < kTilesAtStart && !stored_.empty(); ++i) {
    restore(stored_.back());
    stored_.pop_back();
  }
  restored_ = 0;
  publish();
}

bool LocalMap::follow(const PoseEstimate& pose) {
  if (pose.session != session_ || place_unknown(pose) || !is_on_grid(pose)) return false;
  const Eigen::Vector3d p_map_base = pose.T_map_base.translation();
  const bool new_tile = !started_ || LocalFrame(p_map_base, cell_m_).origin_cell !=
                                         LocalFrame(last_pose_.T_map_base.translation(), cell_m_).origin_cell;
  last_pose_ = pose;
  started_ = true;
  if (new_tile) {
    evict(p_map_base);
    look_for_stored(p_map_base);
  }
  if (!new_tile && stored_.empty()) return false;
  bring_back_stored();
  publish();
  return true;
}

void LocalMap::store_all() {
  if (storage_ == nullptr) {
    return;
  }
  for (const TileKey& key : TileKey::sorted(tiles_)) store(key);
}

// Removes the tiles beyond the radius from memory, plus one tile of hysteresis, and stores them.
void LocalMap::evict(const Eigen::Vector3d& p_map_base) {
  for (const TileKey& key : TileKey::sorted(tiles_)) {
    if ((centre_of(key, cell_m_) - p_map_base).norm() > config_.radius_m + tile_m(cell_m_)) {
      if (storage_ != nullptr) store(key);
      tiles_.erase(key);
    }
  }
}

// Lists the stored tiles within the radius that are not in memory, the farthest first.
void LocalMap::look_for_stored(const Eigen::Vector3d& p_map_base) {
  stored_.clear();
  if (storage_ == nullptr) {
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
            storage_->contains(key)) {
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

// Reads the nearest of the listed tiles, up to kTilesPerUpdate of them.
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
