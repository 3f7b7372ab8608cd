// SPDX-License-Identifier: BSD-3-Clause
// The map around the robot: takes registered scans, gives immutable snapshots. Owned by one thread.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/estimates.hpp"
#include "core/map/free_space.hpp"
#include "core/map/map_config.hpp"
#include "core/map/map_point.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/map/map_tile.hpp"

namespace isobar {

/// Density-controlled planes on a grid of cells, in tiles around the robot. Memory is bounded by the radius.
class LocalMap {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link; rays start there.
  LocalMap(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar);

  /// Takes a registered scan if the robot moved or the place is new (see MapConfig). Points of a scan with
  /// mode kPriorOnly are taken only where nothing is known yet. Points of tiles that left the radius are
  /// appended to `evicted`. Returns true where snapshot() changed.
  bool update(const RegisteredScan& scan, std::vector<MapPoint>& evicted);

  /// The newest snapshot; never null. Give it to a SnapshotExchange.
  [[nodiscard]] const std::shared_ptr<const MapSnapshot>& snapshot() const { return snapshot_; }

  /// Appends every point now in memory (for map.ply, after what was evicted). Sorted, so that equal input
  /// gives equal output.
  void append_points(std::vector<MapPoint>& points) const;

  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }
  /// Cells removed because rays passed through them, since the start.
  [[nodiscard]] std::uint64_t seen_through_count() const { return seen_through_count_; }

 private:
  struct KeyHash {
    std::size_t operator()(const TileKey& key) const { return key.hash(); }
  };
  struct Touched {
    MapTile* tile;
    std::uint32_t cell;
  };
  /// A cell's own plane must be this much better than required, else its neighbours help.
  static constexpr float kOwnCellShare = 0.5F;

  [[nodiscard]] bool wants(const PoseEstimate& pose) const;
  void insert(const RegisteredScan& scan);
  void remove_seen_through(const RegisteredScan& scan);
  [[nodiscard]] Moments neighbourhood(const MapTile& centre_tile, const MapCell& centre) const;
  bool fit_cell(const MapTile& tile, const MapCell& cell, Plane& plane_tile) const;
  void fit_touched();
  void evict(const Eigen::Vector3d& p_map_base, std::vector<MapPoint>& evicted);
  void publish();
  MapTile& tile(const TileKey& key);
  [[nodiscard]] MapTile* find_tile(const TileKey& key) const;

  MapConfig config_;
  PlaneCriteria criteria_;
  Eigen::Isometry3d T_base_lidar_;
  int cells_per_edge_;
  std::unordered_map<TileKey, std::unique_ptr<MapTile>, KeyHash> tiles_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::vector<Touched> touched_;  // cells that wait for a fit
  FreeSpace free_space_;
  PoseEstimate last_pose_;
  bool started_ = false;
  std::uint64_t seen_through_count_ = 0;
};

}  // namespace isobar
