// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/local_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/geometry.hpp"
#include "core/map/plane_hash.hpp"
#include "core/map/scan_decimation.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Interval over which scans share the insertion of points [s]: scans so close together hit nearly the same
// places. At 10 Hz each scan inserts every second point; over 24 recordings the poses are as good as with
// all.
constexpr double kInsertIntervalS = 0.2;
// Overlap (share of matched points) below which the place is new and all points of the scan are inserted.
constexpr double kNewPlaceOverlap = 0.5;

// True if the cube of 4 x 4 x 4 cells that contains `place` has a plane.
bool plane_in_cube(const MapBlock& block, int place) {
  bool any = false;
  if (block.planes() != nullptr) {
    for_each_in_cube(block.planes()->mask, place, [&](int /*slot*/) { any = true; });
  }
  return any;
}

}  // namespace

LocalMap::LocalMap(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, TileStorage* storage,
                   std::uint32_t session)
    : config_(config),
      cell_m_(static_cast<float>(config.cell_m)),
      T_base_lidar_(T_base_lidar),
      storage_(storage),
      session_(session),
      fitter_(config, [this](const TileKey& key) { return find_tile(key); }),
      snapshot_(std::make_shared<const MapSnapshot>(session)),
      seen_through_(config, T_base_lidar) {}

void LocalMap::configure(const MapConfig& config) {
  const MapConfig before = config_;
  config_ = config;
  config_.cell_m = before.cell_m;
  config_.matcher = before.matcher;
  fitter_ = PlaneFitter(config_, [this](const TileKey& key) { return find_tile(key); });
  seen_through_ = SeenThrough(config_, T_base_lidar_);
}

void LocalMap::set_move(const MapMove& move) {
  move_ = move;
  publish();
}

bool LocalMap::wants(const PoseEstimate& pose) const {
  if (!started_) {
    return true;
  }
  const Eigen::Isometry3d step = last_pose_.T_map_base.inverse() * pose.T_map_base;
  const double elapsed_s = seconds_between(last_pose_.stamp_ns, pose.stamp_ns);
  return step.translation().norm() >= config_.update_distance_m ||
         rotation_angle_rad(Eigen::Quaterniond(step.linear())) >= config_.update_angle_deg * kRadPerDeg ||
         elapsed_s >= config_.update_interval_s || elapsed_s < 0.0 || pose.overlap < config_.update_overlap;
}

bool LocalMap::is_on_grid(const PoseEstimate& pose) {
  constexpr double kMaxCoordinateM = 1e8;  // a cell index must fit into 32 bits; no robot drives that far
  const auto& T = pose.T_map_base.matrix();
  return T.allFinite() && T.cwiseAbs().maxCoeff() <= kMaxCoordinateM;
}

bool LocalMap::update(const RegisteredScan& scan) {
  if (scan.point_count == 0 || !scan.pose.for_map || scan.pose.session != session_ ||
      scan.pose.map_moves != move_.number || !is_on_grid(scan.pose) || !wants(scan.pose)) {
    return false;
  }
  const Eigen::Vector3d p_map_base = scan.pose.T_map_base.translation();
  const bool new_tile = !started_ || LocalFrame(p_map_base, cell_m_).origin_cell !=
                                         LocalFrame(last_pose_.T_map_base.translation(), cell_m_).origin_cell;
  const double elapsed_s = started_ ? seconds_between(last_pose_.stamp_ns, scan.pose.stamp_ns) : 0.0;
  last_pose_ = scan.pose;
  started_ = true;
  if (new_tile) {
    evict(p_map_base);
    look_for_stored(p_map_base);
  }
  bring_back_stored();
  insert(scan, elapsed_s);
  if (config_.see_through_limit > 0 && scan.pose.mode == PoseMode::kRegistered) {
    remove_seen_through(scan, elapsed_s);
  }
  refit_stale();
  publish();
  return true;
}

const MapTile* LocalMap::find_tile(const TileKey& key) const {
  const auto found = tiles_.find(key);
  return found == tiles_.end() ? nullptr : &found->second->cells;
}

void LocalMap::insert(const RegisteredScan& scan, double elapsed_s) {
  const bool known_place = scan.pose.mode == PoseMode::kRegistered && scan.pose.overlap >= kNewPlaceOverlap;
  const std::size_t step = known_place ? decimation_factor(elapsed_s, kInsertIntervalS) : 1;
  const LocalFrame frame(scan.pose.T_map_base.translation(), cell_m_);
  Eigen::Isometry3f T_local_base = scan.pose.T_map_base.cast<float>();
  T_local_base.translation() = frame.to_local(scan.pose.T_map_base.translation());
  const Eigen::Vector3f p_local_lidar = T_local_base * T_base_lidar_.translation().cast<float>();
  const auto radius = static_cast<float>(config_.radius_m);
  recent_.fill(nullptr);
  std::size_t count = 0;
  for (std::size_t i = ++insert_count_ % step; i < scan.point_count; i += step) {
    const ScanPoint& point = scan.points[i];
    const Eigen::Vector3f p_local = T_local_base * Eigen::Vector3f(point.x_m, point.y_m, point.z_m);
    const Eigen::Vector3f ray = p_local_lidar - p_local;
    const float range = ray.norm();
    if (!(range < radius) || range < 1e-3F) {
      continue;
    }
    const CellIndex cell = frame.cell_of(p_local);
    Tile* tile = recent_tile(tile_of(cell));
    if (tile == nullptr) {
      continue;
    }
    PendingPoint& pending = pending_points_[count++];
    pending = {tile, block_of(cell), place_of(cell), nullptr, {}};
    pending.block = &tile->cells.block_or_add(pending.block_index);
    pending.observation = {(p_local - frame.corner_local(cell)) / cell_m_, ray / range, point.intensity,
                           config_.freeze_observations};
    pending.block->prefetch_mask(pending.place);
    if (count == pending_points_.size()) {
      observe_pending(std::exchange(count, 0), scan.pose.mode);
    }
  }
  observe_pending(count, scan.pose.mode);
}

// tile_for_points() with a direct-mapped cache: consecutive points come from different rings, which alternate
// between a few tiles.
LocalMap::Tile* LocalMap::recent_tile(const TileKey& key) {
  Tile*& last = recent_[key.hash() % recent_.size()];
  if (last == nullptr || last->cells.key() != key) {
    last = tile_for_points(key);
  }
  return last;
}

void LocalMap::observe_pending(std::size_t count, PoseMode mode) {
  const std::span points = std::span(pending_points_).first(count);
  for (const PendingPoint& point : points) point.block->prefetch_cell(point.place);
  for (const PendingPoint& point : points) {
    if (mode == PoseMode::kPriorOnly && plane_in_cube(*point.block, point.place)) {
      continue;
    }
    const int slot = point.block->observe(point.place, point.observation);
    if (slot != MapBlock::kNoSlot) waiting_in(*point.tile, point.block_index).insert(slot);
  }
}

void LocalMap::remove_seen_through(const RegisteredScan& scan, double elapsed_s) {
  const auto limit = static_cast<std::uint8_t>(config_.see_through_limit);
  seen_through_.set_scan(scan, elapsed_s);
  for (auto& [key, tile] : tiles_) {
    if (!seen_through_.reaches(key)) {
      continue;
    }
    for (std::size_t b = 0; b < kBlocksPerTile; ++b) {
      MapBlock* block = tile->cells.block(b);
      if (block == nullptr || !seen_through_.count(key, b, *block)) continue;
      seen_through_count_ += block->remove_seen_through(limit);
      waiting_in(*tile, b);
    }
  }
}

// Slots of a block that wait for a refit. Adds the block to stale_ if it is not there.
SlotSet& LocalMap::waiting_in(Tile& tile, std::size_t block) {
  std::int32_t& index = tile.cells.block(block)->list_index;
  if (index == MapBlock::kNotListed) {
    index = static_cast<std::int32_t>(stale_.size());
    stale_.push_back({&tile, block, {}});
  }
  return stale_[static_cast<std::size_t>(index)].waiting;
}

void LocalMap::refit_stale() {
  for (const StaleBlock& stale : stale_) {
    Tile& tile = *stale.tile;
    const bool refitted = fitter_.refit(tile.cells, stale.block, stale.waiting);
    tile.changed = refitted || tile.changed;
    tile.unstored = refitted || tile.unstored;
    tile.cells.block(stale.block)->list_index = MapBlock::kNotListed;
  }
  stale_.clear();
}

void LocalMap::publish() {
  std::vector<std::shared_ptr<const PlaneTile>> planes;
  std::vector<std::shared_ptr<const TileTree>> trees;
  const bool wants_trees = config_.matcher == Matcher::kNearest;
  for (auto& [key, tile] : tiles_) {
    const bool changed = std::exchange(tile->changed, false);
    if (changed) tile->cells.publish();
    if (tile->cells.planes()->plane_count == 0) {
      tile->tree = nullptr;
    } else if (wants_trees) {
      if (changed) tile->tree = std::make_shared<const TileTree>(*tile->cells.planes(), cell_m_);
      trees.push_back(tile->tree);
    } else {
      planes.push_back(tile->cells.planes());
    }
  }
  std::shared_ptr<MapSnapshot> next;
  if (wants_trees) {
    next = std::make_shared<NearestPlane>(std::move(trees), cell_m_, session_);
  } else {
    next = std::make_shared<PlaneHash>(std::move(planes), cell_m_, session_);
  }
  next->set_move(move_);
  snapshot_ = std::move(next);
}

void LocalMap::append_points(std::vector<MapPoint>& points) const {
  for (const TileKey& key : TileKey::sorted(tiles_)) {
    tiles_.at(key)->cells.append_points(cell_m_, points);
  }
}

void LocalMap::append_points(const TileKey& key, std::vector<MapPoint>& points) const {
  if (const MapTile* tile = find_tile(key)) tile->append_points(cell_m_, points);
}

std::size_t LocalMap::cell_count() const {
  std::size_t count = 0;
  for (const auto& [key, tile] : tiles_) {
    count += tile->cells.cell_count();
  }
  return count;
}

}  // namespace isobar
