// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor_map.hpp"

#include <algorithm>
#include <limits>

namespace isobar {

namespace {

/// Two points at each surface that counts as ground.
std::vector<MapPoint> ground_points(std::span<const MapPoint> points) {
  GroundColumns ground;
  ground.add(points);
  ground.finish();
  std::vector<MapPoint> kept;
  for (const GroundColumns::Surface& surface : ground.surfaces()) {
    if (surface.count < GroundColumns::kLeastPoints) continue;
    MapPoint point;
    const Eigen::Vector2d plan =
        Eigen::Vector2d(surface.column.x + 0.5, surface.column.y + 0.5) * GroundColumns::kColumnM;
    point.p_map = {plan.x(), plan.y(), static_cast<double>(surface.height_m)};
    point.normal_map = Eigen::Vector3f::UnitZ();
    kept.insert(kept.end(), GroundColumns::kLeastPoints, point);
  }
  return kept;
}

Eigen::AlignedBox2d extent_of(const GroundColumns& ground, std::span<const Eigen::Vector3d> path) {
  Eigen::AlignedBox2d box;
  for (const GroundColumns::Surface& surface : ground.surfaces()) {
    box.extend(Eigen::Vector2d(surface.column.x, surface.column.y) * GroundColumns::kColumnM);
  }
  for (const Eigen::Vector3d& place : path) box.extend(place.head<2>());
  return box;
}

}  // namespace

void FloorMap::set_tile(const TileKey& key, std::span<const MapPoint> points) {
  Tile& tile = tiles_[key];
  points_ -= tile.points.size();
  tile.points = PackedPoints(points);
  tile.is_whole = true;
  tile.middle_m = Eigen::Vector2d::Zero();
  for (const MapPoint& point : points)
    tile.middle_m += point.p_map.head<2>() / static_cast<double>(points.size());
  points_ += tile.points.size();
  if (tile.points.size() == 0) tiles_.erase(key);
}

void FloorMap::drive_to(const Eigen::Vector3d& p_map_base) {
  if (!p_map_base.allFinite()) return;
  const bool stands = path_.size() >= 2 && (path_.back() - path_[path_.size() - 2]).norm() < spacing_m_;
  if (stands) {
    path_.back() = p_map_base;
  } else {
    path_.push_back(p_map_base);
  }
  if (path_.size() > limits_.places) thin_path();
}

bool FloorMap::arrive_at(std::int64_t stamp_ns, const Eigen::Vector3d& p_map_base) {
  if (!p_map_base.allFinite()) return false;
  drive_to(p_map_base);
  arrival_.drive_to(stamp_ns, p_map_base);
  return arrival_.open(ground_, floors_);
}

void FloorMap::forget_tiles() {
  tiles_.clear();
  points_ = 0;
}

// The first place stays: the floors are counted from it.
void FloorMap::thin_path() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < path_.size(); i += 2) path_[kept++] = path_[i];
  path_.resize(kept);
  spacing_m_ *= 2.0;
}

// Of the farthest tiles only the ground is kept, by which floors are found.
void FloorMap::keep_limit() {
  if (points_ <= limits_.points || path_.empty()) return;
  const Eigen::Vector2d robot = path_.back().head<2>();
  std::vector<TileKey> whole;
  for (const TileKey& key : keys()) {
    if (tiles_.at(key).is_whole) whole.push_back(key);
  }
  std::sort(whole.begin(), whole.end(), [&](const TileKey& a, const TileKey& b) {
    return (tiles_.at(a).middle_m - robot).squaredNorm() > (tiles_.at(b).middle_m - robot).squaredNorm();
  });
  std::vector<MapPoint> points;
  for (const TileKey& key : whole) {
    if (points_ <= limits_.points) return;
    Tile& tile = tiles_.at(key);
    tile.points.unpack(points);
    points_ -= tile.points.size();
    tile.points = PackedPoints(ground_points(points));
    tile.is_whole = false;
    points_ += tile.points.size();
  }
}

void FloorMap::find() {
  keep_limit();
  ground_ = GroundColumns();
  std::vector<MapPoint> points;
  for (const TileKey& key : keys()) {
    tiles_.at(key).points.unpack(points);
    ground_.add(points);
  }
  ground_.finish();
  extent_m_ = extent_of(ground_, path_);
  floors_ = find_floors(ground_, path_);
  arrival_.renew(floors_);
}

OccupancyGrid FloorMap::grid(const Floor& floor) const {
  const double widest_m = limits_.grid_cells * config_.resolution_m;
  if (!extent_m_.isEmpty() && extent_m_.sizes().maxCoeff() > widest_m)
    return grid_around(floor, 0.5 * widest_m);
  FloorGrid grid(ground_, floors_, floor, path_, config_);
  std::vector<MapPoint> points;
  for (const TileKey& key : keys()) {
    tiles_.at(key).points.unpack(points);
    grid.add(points);
  }
  return grid.finish();
}

// The ground is that of the tiles around the robot alone, so that the grid does not become larger.
OccupancyGrid FloorMap::grid_around(const Floor& floor, double reach_m) const {
  const Eigen::Vector2d robot =
      path_.empty() ? Eigen::Vector2d::Zero() : Eigen::Vector2d(path_.back().head<2>());
  const auto is_near = [&](const Eigen::Vector2d& p_map) {
    return (p_map - robot).cwiseAbs().maxCoeff() < reach_m;
  };
  std::vector<std::vector<MapPoint>> near;
  GroundColumns ground;
  for (const TileKey& key : keys()) {
    const Tile& tile = tiles_.at(key);
    if (!tile.is_whole || !is_near(tile.middle_m)) continue;
    tile.points.unpack(near.emplace_back());
    ground.add(near.back());
  }
  ground.finish();
  std::vector<Eigen::Vector3d> path;
  std::copy_if(path_.begin(), path_.end(), std::back_inserter(path),
               [&](const Eigen::Vector3d& place) { return is_near(place.head<2>()); });
  FloorGrid grid(ground, floors_, floor, path, config_);
  for (const std::vector<MapPoint>& points : near) grid.add(points);
  return grid.finish();
}

}  // namespace isobar
