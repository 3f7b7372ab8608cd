// SPDX-License-Identifier: BSD-3-Clause
// The map around the robot: takes registered scans, gives immutable snapshots. Owned by one thread.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/estimates.hpp"
#include "core/map/map_config.hpp"
#include "core/map/map_point.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/map/map_tile.hpp"
#include "core/map/nearest_plane.hpp"
#include "core/map/plane_fitter.hpp"
#include "core/map/seen_through.hpp"
#include "core/map/tile_shelf.hpp"

namespace isobar {

/// Density-controlled planes on a grid of cells, in tiles around the robot. Memory is bounded by the radius;
/// what leaves it goes to the shelf and comes back when the robot does.
class LocalMap {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link; rays start there. `shelf` may be null: what leaves the
  /// radius is forgotten then.
  LocalMap(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, TileShelf* shelf = nullptr);
  LocalMap(const LocalMap&) = delete;
  LocalMap& operator=(const LocalMap&) = delete;

  /// Takes a registered scan if the robot moved or the place is new (see MapConfig). Points of a scan with
  /// mode kPriorOnly are taken only where nothing is known yet. Of scans less than 0.2 s apart, in a place
  /// that is known, each gives a part of its points, in turns. Returns true where snapshot() changed.
  bool update(const RegisteredScan& scan);

  /// The newest snapshot; never null. Give it to a SnapshotExchange.
  [[nodiscard]] const std::shared_ptr<const MapSnapshot>& snapshot() const { return snapshot_; }

  /// Appends every point now in memory. Sorted, so that equal input gives equal output.
  void append_points(std::vector<MapPoint>& points) const;

  /// Puts a copy of every tile in memory on the shelf, for the end of a run.
  void store_all();

  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] std::size_t plane_count() const { return snapshot_->plane_count(); }
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }
  /// Cells removed because rays passed through them, since the start.
  [[nodiscard]] std::uint64_t seen_through_count() const { return seen_through_count_; }
  /// Tiles that the shelf could not keep or give back, since the start.
  [[nodiscard]] std::uint64_t lost_tile_count() const { return lost_tile_count_; }

 private:
  struct KeyHash {
    std::size_t operator()(const TileKey& key) const { return key.hash(); }
  };
  struct Tile {
    explicit Tile(const TileKey& key) : cells(key) {}
    MapTile cells;
    std::shared_ptr<const TileTree> tree;  // of cells.planes(), where the matcher wants one
    bool changed = true;                   // since cells.publish()
  };
  // A block whose planes may be out of date, and its cells that wait for a fit.
  struct StaleBlock {
    Tile* tile = nullptr;
    std::size_t block = 0;
    SlotSet waiting;
  };

  // A point on its way into the map. Cells lie all over the memory: for many points at once the block, then
  // the cell is fetched before the first is needed.
  struct Landing {
    Tile* tile = nullptr;
    std::size_t block_index = 0;
    int place = 0;
    MapBlock* block = nullptr;
    MapBlock::Observation observation;
  };

  [[nodiscard]] bool wants(const PoseEstimate& pose) const;
  void insert(const RegisteredScan& scan, double elapsed_s);
  void observe_landings(std::size_t count, PoseMode mode);
  [[nodiscard]] Tile* recent_tile(const TileKey& key);
  void remove_seen_through(const RegisteredScan& scan, double elapsed_s);
  SlotSet& waiting_in(Tile& tile, std::size_t block);
  void refit_stale();
  void shelve(const TileKey& key);
  void evict(const Eigen::Vector3d& p_map_base);
  void look_for_stored(const Eigen::Vector3d& p_map_base);
  void bring_back_stored();
  void publish();
  [[nodiscard]] Tile* tile_for_points(const TileKey& key);
  Tile* restore(const TileKey& key);
  [[nodiscard]] const MapTile* find_tile(const TileKey& key) const;

  MapConfig config_;
  float cell_m_;
  Eigen::Isometry3d T_base_lidar_;
  TileShelf* shelf_;
  PlaneFitter fitter_;
  std::unordered_map<TileKey, std::unique_ptr<Tile>, KeyHash> tiles_;
  std::shared_ptr<const MapSnapshot> snapshot_ = std::make_shared<const MapSnapshot>();
  std::array<Landing, 32> landings_;
  std::array<Tile*, 64> recent_{};
  std::vector<StaleBlock> stale_;  // what this update changed
  std::vector<TileKey> stored_;    // tiles of the shelf to bring back, the nearest last
  std::size_t restored_ = 0;       // in this update
  std::vector<std::byte> bytes_;   // scratch
  SeenThrough seen_through_;
  PoseEstimate last_pose_;
  bool started_ = false;
  std::size_t insert_count_ = 0;
  std::uint64_t seen_through_count_ = 0;
  std::uint64_t lost_tile_count_ = 0;
};

}  // namespace isobar
