// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_cloud.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/clock/robot_clock.hpp"

namespace isobar {
namespace {

/// Square of the distance of a tile from a place, in edges of a tile.
double distance_to(const TileKey& key, const Eigen::Vector3d& place) {
  return (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5 - place.array()).matrix().squaredNorm();
}

}  // namespace

void MapCloudPublisher::start_over() noexcept {
  stage_ = Stage::kIdle;
  told_left_out_ = false;
}

void MapCloudPublisher::step(const LocalMap& map, FileTileStore* store, const PoseEstimate& pose) noexcept {
  if (stage_ == Stage::kIdle) {
    if (!clouds_.has_subscribers()) {
      release();
      return;
    }
    const std::int64_t since_ns = pose.stamp_ns - began_ns_;
    if (since_ns >= 0 && since_ns < interval_ns_) return;
    began_ns_ = pose.stamp_ns;
    list_tiles(map, store, pose.T_map_base.translation());
    stage_ = Stage::kReading;
  }
  if (stage_ == Stage::kReading) {
    read_some(map, store);
    if (!to_read_.empty()) return;
    add_tiles_in_memory(map);
    stamp_ns_ = pose.stamp_ns;
    ++sequence_;
    sent_ = 0;
    stage_ = points_.empty() ? Stage::kIdle : Stage::kSending;
  }
  if (stage_ == Stage::kSending) send_piece(map.session());
}

// The memory of a cloud that nobody asks for any more. The first one who does gets the next cloud at once.
void MapCloudPublisher::release() noexcept {
  if (points_.capacity() == 0) return;
  points_ = {};
  map_points_ = {};
  stored_ = {};
  began_ns_ = 0;
}

void MapCloudPublisher::list_tiles(const LocalMap& map, const FileTileStore* store,
                                   const Eigen::Vector3d& p_map_base) {
  points_.clear();
  stored_.clear();
  in_memory_.clear();
  to_read_.clear();
  if (store == nullptr) return;
  to_read_ = store->keys();
  const auto first_in_memory = std::partition(to_read_.begin(), to_read_.end(),
                                              [&map](const TileKey& key) { return !map.has_tile(key); });
  in_memory_.assign(first_in_memory, to_read_.end());
  to_read_.erase(first_in_memory, to_read_.end());
  const Eigen::Vector3d place = p_map_base / store->header().tile_m;
  std::sort(to_read_.begin(), to_read_.end(), [&place](const TileKey& a, const TileKey& b) {
    return std::pair(distance_to(b, place), b) < std::pair(distance_to(a, place), a);
  });
}

void MapCloudPublisher::read_some(const LocalMap& map, FileTileStore* store) {
  if (store == nullptr) to_read_.clear();
  const std::int64_t end_ns = RobotClock::now_ns() + reading_time_ns_;
  while (!to_read_.empty()) {
    const TileKey key = to_read_.back();
    to_read_.pop_back();
    if (!map.has_tile(key)) read(key, *store);
    if (to_read_.empty()) {
      // Tiles that have left memory since the cloud began.
      for (const TileKey& late : std::exchange(in_memory_, {})) {
        if (!map.has_tile(late)) to_read_.push_back(late);
      }
    }
    if (RobotClock::now_ns() >= end_ns) return;
  }
}

void MapCloudPublisher::read(const TileKey& key, FileTileStore& store) {
  if (points_.size() >= kMostStoredPoints) {
    to_read_.clear();
    if (!std::exchange(told_left_out_, true)) {
      spdlog::warn("map cloud: tiles beyond {} points are left out, the farthest; isobar map export has them",
                   kMostStoredPoints);
    }
    return;
  }
  map_points_.clear();
  // The store counts tiles that it cannot read.
  if (!store.take(key, bytes_) || !MapTile::append_stored_points(bytes_, map_points_)) return;
  stored_.push_back({key, points_.size(), map_points_.size()});
  append(map_points_);
}

void MapCloudPublisher::add_tiles_in_memory(const LocalMap& map) {
  // Tiles that came back to memory after they had been read: from the last one on, so that the points that fill
  // the hole are those of tiles that stay.
  for (std::size_t i = stored_.size(); i-- > 0;) {
    const Stored& tile = stored_[i];
    if (!map.has_tile(tile.key)) continue;
    const std::size_t behind = points_.size() - tile.first - tile.count;
    const std::size_t moved = std::min(tile.count, behind);
    std::copy_n(points_.end() - static_cast<std::ptrdiff_t>(moved), moved,
                points_.begin() + static_cast<std::ptrdiff_t>(tile.first));
    points_.resize(points_.size() - tile.count);
  }
  map_points_.clear();
  map.append_points(map_points_);
  append(map_points_);
}

void MapCloudPublisher::append(const std::vector<MapPoint>& points) {
  for (const MapPoint& point : points) {
    const Eigen::Vector3f p_map = point.p_map.cast<float>();
    points_.push_back({p_map.x(), p_map.y(), p_map.z(), 0, 0, point.intensity});
  }
}

void MapCloudPublisher::send_piece(std::uint32_t session) noexcept {
  ipc::MapCloud* piece = clouds_.loan();
  if (piece == nullptr) return;
  piece->stamp_ns = stamp_ns_;
  piece->sequence = sequence_;
  piece->session = session;
  piece->first_point = static_cast<std::uint32_t>(sent_);
  piece->total_points = static_cast<std::uint32_t>(points_.size());
  piece->point_count = std::min(ipc::MapCloud::kMaxPoints, piece->total_points - piece->first_point);
  std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(sent_), piece->point_count, piece->points);
  sent_ += piece->point_count;
  clouds_.publish(piece);
  if (sent_ == points_.size()) stage_ = Stage::kIdle;
}

}  // namespace isobar
