// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/map_mover.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.hpp"
#include "core/so3.hpp"

namespace isobar {
namespace {

// Share of the key scans that a map may lack: those of a disk that was full for a moment.
constexpr double kMostMissing = 0.02;

}  // namespace

MapMover::MapMover(const MapMoveConfig& config, const MapConfig& map, const Eigen::Isometry3d& T_base_lidar,
                   BuildingStorage& storage)
    : config_(config),
      map_config_(map),
      T_base_lidar_(T_base_lidar),
      storage_(storage),
      scan_(std::make_unique<RegisteredScan>()) {}

bool MapMover::is_due(const Building& building) const {
  if (active() || !problem_.empty()) return false;
  for (const Submap& submap : building.submaps()) {
    const Eigen::Isometry3d T_map_submap = building.T_map_submap(submap.number);
    for (const KeyScan& key : submap.keys) {
      const bool moved = submap.number < T_laid_.size() && key.stamp_ns <= laid_ns_;
      const Eigen::Isometry3d T_laid = moved ? T_laid_[submap.number] * key.T_submap_base : key.T_map_base;
      const Eigen::Isometry3d T_now = T_map_submap * key.T_submap_base;
      const double moved_m = (T_now.translation() - T_laid.translation()).norm();
      const double turned_rad = std::abs(yaw_of(T_now.linear() * T_laid.linear().transpose()));
      if (moved_m > config_.least_m || turned_rad > config_.least_deg * kRadPerDeg) return true;
    }
  }
  return false;
}

void MapMover::begin(const Building& building, TileStorage& tiles, std::uint32_t session) {
  map_ = std::make_unique<LocalMap>(map_config_, T_base_lidar_, &tiles, session);
  T_map_submap_.clear();
  for (const Submap& submap : building.submaps()) {
    T_map_submap_.push_back(building.T_map_submap(submap.number));
  }
  submap_ = key_ = laid_keys_ = missing_ = 0;
}

std::optional<MovedMap> MapMover::step(const Building& building, const MapMove& before) {
  const std::vector<Submap>& submaps = building.submaps();
  while (T_map_submap_.size() < submaps.size()) {
    T_map_submap_.push_back(T_map_submap_.back() * submaps[T_map_submap_.size()].link.T_before_submap);
  }
  for (std::size_t laid = 0; laid < config_.keys_per_step;) {
    if (key_ < submaps[submap_].keys.size()) {
      lay(submaps[submap_].keys[key_++], T_map_submap_[submap_]);
      ++laid;
    } else if (submap_ + 1 < submaps.size() && !submaps[submap_ + 1].keys.empty()) {
      ++submap_;
      key_ = 0;
    } else {
      return finish(building, before);
    }
  }
  return std::nullopt;
}

void MapMover::lay(const KeyScan& key, const Eigen::Isometry3d& T_map_submap) {
  if (key.scan == kNoScanHandle || !storage_.read_scan(key.scan, *scan_)) {
    ++missing_;
    return;
  }
  scan_->pose.session = map_->session();
  scan_->pose.T_map_base = T_map_submap * key.T_submap_base;
  map_->update(*scan_);
  ++laid_keys_;
}

// The robot goes on from the last key scan.
std::optional<MovedMap> MapMover::finish(const Building& building, const MapMove& before) {
  if (static_cast<double>(missing_) > kMostMissing * static_cast<double>(laid_keys_)) {
    map_.reset();
    problem_ = "the map is not moved with its loops any more: " + std::to_string(missing_) +
               " key scans of it cannot be read (loops.max_disk_gb?)";
    return std::nullopt;
  }
  const KeyScan& last = building.last_key();
  MovedMap moved;
  moved.T_now_before =
      upright(T_map_submap_[building.holder()] * last.T_submap_base) * upright(last.T_map_base).inverse();
  moved.map = std::move(map_);
  moved.map->set_move({before.number + 1, moved.T_now_before * before.T_now_first});
  moved.map->store_all();
  T_laid_ = std::move(T_map_submap_);
  laid_ns_ = last.stamp_ns;
  return moved;
}

}  // namespace isobar
