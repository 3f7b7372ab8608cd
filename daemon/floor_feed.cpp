// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/floor_feed.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "drivers/clock/robot_clock.hpp"

namespace isobar {

FloorTiles FloorFeed::take() {
  const std::lock_guard lock(mutex_);
  waiting_points_ = 0;
  FloorTiles taken = std::exchange(waiting_, FloorTiles());
  waiting_.session = taken.session;
  waiting_.map_moves = taken.map_moves;
  return taken;
}

bool FloorFeed::has_room() {
  const std::lock_guard lock(mutex_);
  return waiting_points_ < kMostWaiting;
}

void FloorFeed::step(const LocalMap& map, FileTileStore* store, const Eigen::Vector3d& p_map_base) noexcept {
  if (map.session() != session_ || map.move().number != map_moves_) {
    session_ = map.session();
    map_moves_ = map.move().number;
    handed_over_.clear();
    is_listed_ = false;
  }
  if (!asked_.load(std::memory_order_acquire) || !has_room()) return;
  if (!is_listed_) list_tiles(map, store, p_map_base);
  const std::int64_t end_ns = RobotClock::now_ns() + step_ns_;
  FloorTiles next;
  next.session = session_;
  next.map_moves = map_moves_;
  while (!to_read_.empty()) {
    const TileKey key = to_read_.back();
    to_read_.pop_back();
    read(key, map, store, next.tiles.emplace_back());
    if (RobotClock::now_ns() >= end_ns) break;
  }
  if (to_read_.empty()) {
    next.is_whole = true;
    is_listed_ = false;
    asked_.store(false, std::memory_order_release);
  }
  hand_over(std::move(next));
}

void FloorFeed::list_tiles(const LocalMap& map, const FileTileStore* store,
                           const Eigen::Vector3d& p_map_base) {
  to_read_ = map.tile_keys();
  if (store != nullptr) {
    for (const TileKey& key : store->keys()) {
      const auto known = handed_over_.find(key);
      // What was handed over from memory has changed until it was written.
      const bool is_news = known == handed_over_.end() || known->second;
      if (is_news && !map.has_tile(key)) to_read_.push_back(key);
    }
  }
  const Eigen::Vector3d place = p_map_base / tile_m(static_cast<float>(map.config().cell_m));
  const auto distance = [&place](const TileKey& key) {
    return (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5 - place.array()).matrix().squaredNorm();
  };
  std::sort(to_read_.begin(), to_read_.end(), [&](const TileKey& a, const TileKey& b) {
    return std::pair(distance(b), b) < std::pair(distance(a), a);
  });
  is_listed_ = true;
}

void FloorFeed::read(const TileKey& key, const LocalMap& map, FileTileStore* store, FloorTile& tile) {
  tile.key = key;
  const bool in_memory = map.has_tile(key);
  if (in_memory) {
    map.append_points(key, tile.points);
  } else if (store != nullptr && store->take(key, bytes_)) {
    // The store counts tiles that it cannot read.
    if (!MapTile::append_stored_points(bytes_, tile.points)) tile.points.clear();
  }
  handed_over_[key] = in_memory;
}

void FloorFeed::hand_over(FloorTiles&& next) {
  const std::lock_guard lock(mutex_);
  if (waiting_.session != next.session || waiting_.map_moves != next.map_moves) {
    waiting_ = FloorTiles();
    waiting_.session = next.session;
    waiting_.map_moves = next.map_moves;
    waiting_points_ = 0;
  }
  for (const FloorTile& tile : next.tiles) waiting_points_ += tile.points.size();
  std::move(next.tiles.begin(), next.tiles.end(), std::back_inserter(waiting_.tiles));
  waiting_.is_whole = waiting_.is_whole || next.is_whole;
}

}  // namespace isobar
