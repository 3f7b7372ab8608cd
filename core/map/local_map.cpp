// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/geometry.hpp"

namespace isobar {

namespace {

PlaneCriteria criteria_of(const MapConfig& config) {
  PlaneCriteria criteria;
  criteria.max_thickness_m = static_cast<float>(config.max_thickness_m);
  criteria.max_normal_deviation_rad = static_cast<float>(config.max_normal_deviation_deg * kRadPerDeg);
  return criteria;
}

}  // namespace

LocalMap::LocalMap(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar)
    : config_(config),
      criteria_(criteria_of(config)),
      T_base_lidar_(T_base_lidar),
      cells_per_edge_(std::clamp(static_cast<int>(std::lround(kTileSizeM / config.cell_m)), 8, 80)),
      snapshot_(std::make_shared<const MapSnapshot>()) {}

bool LocalMap::wants(const PoseEstimate& pose) const {
  if (!started_) {
    return true;
  }
  const Eigen::Isometry3d step = last_pose_.T_map_base.inverse() * pose.T_map_base;
  const double elapsed_s = static_cast<double>(pose.stamp_ns - last_pose_.stamp_ns) * 1e-9;
  return step.translation().norm() >= config_.update_distance_m ||
         Eigen::AngleAxisd(step.linear()).angle() >= config_.update_angle_deg * kRadPerDeg ||
         elapsed_s >= config_.update_interval_s || elapsed_s < 0.0 || pose.overlap < config_.update_overlap;
}

bool LocalMap::update(const RegisteredScan& scan, std::vector<MapPoint>& evicted) {
  constexpr double kFarthestM = 1e8;  // beyond it a tile's key would not fit, nor would any robot
  const auto& pose = scan.pose.T_map_base.matrix();
  if (scan.point_count == 0 || !pose.allFinite() || pose.cwiseAbs().maxCoeff() > kFarthestM ||
      !wants(scan.pose)) {
    return false;
  }
  const bool moved = !started_ || tile_of(last_pose_.T_map_base.translation()) !=
                                      tile_of(scan.pose.T_map_base.translation());
  last_pose_ = scan.pose;
  started_ = true;
  insert(scan);
  if (config_.see_through_limit > 0 && scan.pose.mode == PoseMode::kRegistered) {
    remove_seen_through(scan);
  }
  fit_touched();
  if (moved) {
    evict(scan.pose.T_map_base.translation(), evicted);
  }
  publish();
  return true;
}

MapTile* LocalMap::find_tile(const TileKey& key) const {
  const auto found = tiles_.find(key);
  return found == tiles_.end() ? nullptr : found->second.get();
}

MapTile& LocalMap::tile(const TileKey& key) {
  std::unique_ptr<MapTile>& found = tiles_[key];
  if (found == nullptr) {
    found = std::make_unique<MapTile>(key, cells_per_edge_);
  }
  return *found;
}

void LocalMap::insert(const RegisteredScan& scan) {
  const Eigen::Isometry3d& T_map_base = scan.pose.T_map_base;
  const Eigen::Vector3d p_map_lidar = T_map_base * T_base_lidar_.translation();
  const bool only_unknown = scan.pose.mode == PoseMode::kPriorOnly;
  const auto freeze = static_cast<float>(config_.freeze_observations);
  MapTile* last = nullptr;
  touched_.clear();
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    const ScanPoint& point = scan.points[i];
    const Eigen::Vector3d p_map = T_map_base * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    const Eigen::Vector3d ray = p_map_lidar - p_map;
    const double range = ray.norm();
    if (!(range < config_.radius_m) || range < 1e-3) {
      continue;
    }
    const TileKey key = tile_of(p_map);
    if (last == nullptr || last->key() != key) {
      last = &tile(key);
    }
    const Eigen::Vector3f p_tile = (p_map - key.origin_map()).cast<float>();
    if (only_unknown && !last->unknown_at(p_tile)) {
      continue;
    }
    const std::ptrdiff_t cell = last->observe(p_tile, (ray / range).cast<float>(), point.intensity, freeze);
    if (cell >= 0) {
      touched_.push_back({last, static_cast<std::uint32_t>(cell)});
    }
  }
}

void LocalMap::remove_seen_through(const RegisteredScan& scan) {
  const Eigen::Isometry3d T_lidar_base = T_base_lidar_.inverse();
  free_space_.set_scan(scan, T_lidar_base);
  const Eigen::Isometry3d T_lidar_map = T_lidar_base * scan.pose.T_map_base.inverse();
  const Eigen::Vector3d p_map_base = scan.pose.T_map_base.translation();
  const double reach = config_.see_through_range_m + kTileSizeM;
  const auto margin = static_cast<float>(config_.see_through_margin_m);
  const auto limit = static_cast<std::uint16_t>(config_.see_through_limit);
  for (auto& [key, tile] : tiles_) {
    const Eigen::Vector3d centre = key.origin_map().array() + kTileSizeM / 2;
    if ((centre - p_map_base).norm() > reach) {
      continue;
    }
    const Eigen::Isometry3f T_lidar_tile =
        (T_lidar_map * Eigen::Translation3d(key.origin_map())).cast<float>();
    bool any = false;
    for (MapCell& cell : tile->cells()) {
      if (cell.moments.count == 0.0F) {
        continue;
      }
      const Eigen::Vector3f q_tile = tile->cell_centre_tile(cell.key) + cell.moments.mean();
      const Eigen::Vector3f normal =
          cell.has_plane ? (T_lidar_tile.linear() * cell.normal).eval() : Eigen::Vector3f::Zero().eval();
      if (free_space_.passes_through(T_lidar_tile * q_tile, normal, margin)) {
        any = ++cell.seen_through > limit || any;
      }
    }
    if (any) {
      seen_through_count_ += tile->remove_seen_through(limit);
    }
  }
}

Moments LocalMap::neighbourhood(const MapTile& centre_tile, const MapCell& centre) const {
  // Cells of the same and of neighbouring tiles, same side only: a thin wall has two.
  const Eigen::Vector3i at = centre_tile.cell_coordinates(centre.key);
  const int side = static_cast<int>(centre.key & 1U);
  const auto cell_m = static_cast<float>(kTileSizeM) / static_cast<float>(cells_per_edge_);
  const int n = cells_per_edge_;
  Moments sum;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const Eigen::Vector3i cell = at + Eigen::Vector3i(dx, dy, dz);
        const auto step = [n](int c) { return c < 0 ? -1 : (c >= n ? 1 : 0); };
        const Eigen::Vector3i shift(step(cell.x()), step(cell.y()), step(cell.z()));
        const TileKey& key = centre_tile.key();
        const MapTile* tile = shift.isZero()
                                  ? &centre_tile
                                  : find_tile({key.x + shift.x(), key.y + shift.y(), key.z + shift.z()});
        if (tile == nullptr) {
          continue;
        }
        const Eigen::Vector3i local = cell - shift * n;
        const MapCell* other = tile->cell_at(local.x(), local.y(), local.z(), side);
        if (other != nullptr && other->moments.count > 0.0F && other->toward.dot(centre.toward) > 0.0F) {
          sum.add(other->moments,
                  Eigen::Vector3f(static_cast<float>(dx), static_cast<float>(dy), static_cast<float>(dz)) *
                      cell_m);
        }
      }
    }
  }
  return sum;
}

bool LocalMap::fit_cell(const MapTile& tile, const MapCell& cell, Plane& plane_tile) const {
  // From the smallest surface that is enough to the largest: the cell, its neighbours, a coarse cell.
  const Eigen::Vector3f centre = tile.cell_centre_tile(cell.key);
  PlaneCriteria own = criteria_;
  own.max_normal_deviation_rad *= kOwnCellShare;
  if (fit_plane(cell.moments, own, plane_tile) ||
      fit_plane(neighbourhood(tile, cell), criteria_, plane_tile)) {
    plane_tile.mean += centre;
  } else {
    Eigen::Vector3f coarse_centre;
    const Moments& coarse = tile.coarse_at(centre, coarse_centre);
    if (!fit_plane(coarse, criteria_, plane_tile)) {
      return false;
    }
    plane_tile.mean += coarse_centre;
  }
  // The plane's point nearest to the cell's own mean.
  const Eigen::Vector3f mean = centre + cell.moments.mean();
  const float off_plane = plane_tile.normal.dot(mean - plane_tile.mean);
  if (std::abs(off_plane) > 2.0F * criteria_.max_thickness_m) {
    return false;
  }
  plane_tile.mean = mean - off_plane * plane_tile.normal;
  return true;
}

void LocalMap::fit_touched() {
  for (const Touched& touched : touched_) {
    MapCell& cell = touched.tile->cells()[touched.cell];
    cell.touched = false;
    if (cell.moments.count == 0.0F) {
      continue;
    }
    Plane plane;
    if (fit_cell(*touched.tile, cell, plane)) {
      touched.tile->set_plane(cell, plane);
    } else {
      touched.tile->clear_plane(cell);
    }
  }
  touched_.clear();
}

void LocalMap::evict(const Eigen::Vector3d& p_map_base, std::vector<MapPoint>& evicted) {
  std::vector<TileKey> far;
  for (const auto& [key, tile] : tiles_) {
    const Eigen::Vector3d centre = key.origin_map().array() + kTileSizeM / 2;
    if ((centre - p_map_base).norm() > config_.radius_m + kTileSizeM) {
      far.push_back(key);
    }
  }
  // In order of place, since the order of a hash table is nobody's promise.
  std::sort(far.begin(), far.end(), [](const TileKey& a, const TileKey& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  for (const TileKey& key : far) {
    tiles_.at(key)->append_points(evicted);
    tiles_.erase(key);
  }
}

void LocalMap::publish() {
  std::vector<std::shared_ptr<const TileIndex>> indices;
  indices.reserve(tiles_.size());
  for (auto& [key, tile] : tiles_) {
    tile->rebuild_index();
    indices.push_back(tile->index());
  }
  snapshot_ = std::make_shared<const MapSnapshot>(std::move(indices));
}

void LocalMap::append_points(std::vector<MapPoint>& points) const {
  std::vector<TileKey> keys;
  keys.reserve(tiles_.size());
  for (const auto& [key, tile] : tiles_) {
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end(), [](const TileKey& a, const TileKey& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  for (const TileKey& key : keys) {
    tiles_.at(key)->append_points(points);
  }
}

std::size_t LocalMap::cell_count() const {
  std::size_t count = 0;
  for (const auto& [key, tile] : tiles_) {
    count += tile->cells().size();
  }
  return count;
}

}  // namespace isobar
