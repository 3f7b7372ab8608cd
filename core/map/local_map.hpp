// SPDX-License-Identifier: BSD-3-Clause
// Local map around the robot: registered scans in, immutable snapshots out. Owned by one thread.
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
#include "core/map/tile_storage.hpp"

namespace isobar {

/// Grid of cells with one plane per cell and side, in tiles around the robot. Memory is bounded by the
/// radius: tiles beyond it move to the tile storage and return when the robot does.
class LocalMap {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link; rays start there. `storage`: may be null; tiles beyond
  /// the radius are then dropped.
  /// `session`: number of the map frame; scans of another one are left out.
  LocalMap(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, TileStorage* storage = nullptr,
           std::uint32_t session = 1);
  LocalMap(const LocalMap&) = delete;
  LocalMap& operator=(const LocalMap&) = delete;

  /// Inserts a registered scan if the robot moved or the place is new (see MapConfig). Points of a scan with
  /// mode kPriorOnly are inserted only where the map has no planes yet. In a known place, scans less than 0.2
  /// s apart are decimated: each inserts another share of its points. Returns true if snapshot() changed.
  bool update(const RegisteredScan& scan);

  /// Changes settings for the next updates, but not the cells' edge and the matcher, which the map has.
  void configure(const MapConfig& config);
  [[nodiscard]] const MapConfig& config() const { return config_; }

  /// Newest snapshot, never null, to be published by a SnapshotExchange.
  [[nodiscard]] const std::shared_ptr<const MapSnapshot>& snapshot() const { return snapshot_; }

  /// Appends every point in memory, sorted: equal input gives equal output.
  void append_points(std::vector<MapPoint>& points) const;

  /// Appends the points of one tile in memory; nothing for another one.
  void append_points(const TileKey& key, std::vector<MapPoint>& points) const;
  /// Keys of the tiles in memory, sorted by x, y, z.
  [[nodiscard]] std::vector<TileKey> tile_keys() const { return TileKey::sorted(tiles_); }

  /// Writes every tile in memory to the storage, for the end of a run.
  void store_all();
  /// Writes some of the tiles whose planes have changed since they were last written, so that a crash loses
  /// little. Called once a second, every change is written within 2 * kSweepParts seconds, and one call writes
  /// a share of 1 / kSweepParts of the changed tiles. Does nothing without a storage.
  void store_some();
  /// The next store_some() begins a sweep over all tiles that have changed by then.
  [[nodiscard]] bool sweep_begins() const { return sweep_.empty(); }
  static constexpr std::size_t kSweepParts = 4;
  /// Another storage, which may hold other versions of the tiles in memory: those count as changed.
  void change_storage(TileStorage* storage);

  /// Reads the stored tiles around a place, the nearest first, and publishes them in snapshot(): the map of
  /// an earlier run. Tiles beyond a maximum follow with the next updates.
  void load_around(const Eigen::Vector3d& p_map_base);

  /// Keeps the tiles around the robot in memory as update() does, and inserts nothing: for a map that is only used. Returns
  /// true if snapshot() changed.
  bool follow(const PoseEstimate& pose);

  [[nodiscard]] std::uint32_t session() const { return session_; }
  /// How the map frame has been corrected; scans whose pose is of another correction are left out.
  [[nodiscard]] const MapMove& move() const { return move_; }
  /// The map has been laid anew at corrected poses: snapshot() says so.
  void set_move(const MapMove& move);
  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }
  /// True if the tile is in memory.
  [[nodiscard]] bool has_tile(const TileKey& key) const { return tiles_.contains(key); }
  /// Cells removed because rays passed through them, since the start.
  [[nodiscard]] std::uint64_t seen_through_count() const { return seen_through_count_; }

 private:
  struct Tile {
    explicit Tile(const TileKey& key) : cells(key) {}
    MapTile cells;
    std::shared_ptr<const TileTree> tree;  // over cells.planes(); null unless the matcher is kNearest
    bool changed = true;                   // since the last cells.publish()
    bool unstored = true;                  // planes have changed since the last store()
  };
  // A block whose planes are out of date, and the slots that wait for a refit.
  struct StaleBlock {
    Tile* tile = nullptr;
    std::size_t block = 0;
    SlotSet waiting;
  };

  // A point to be inserted. Points are collected and inserted in batches, so that the prefetches of their
  // blocks and cells, which are scattered in memory, overlap.
  struct PendingPoint {
    Tile* tile = nullptr;
    std::size_t block_index = 0;
    int place = 0;
    MapBlock* block = nullptr;
    MapBlock::Observation observation;
  };

  [[nodiscard]] static bool is_on_grid(const PoseEstimate& pose);
  [[nodiscard]] bool wants(const PoseEstimate& pose) const;
  void insert(const RegisteredScan& scan, double elapsed_s);
  void observe_pending(std::size_t count, PoseMode mode);
  [[nodiscard]] Tile* recent_tile(const TileKey& key);
  void remove_seen_through(const RegisteredScan& scan, double elapsed_s);
  SlotSet& waiting_in(Tile& tile, std::size_t block);
  void refit_stale();
  bool store(const TileKey& key);
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
  TileStorage* storage_;
  std::uint32_t session_;
  MapMove move_;
  PlaneFitter fitter_;
  std::unordered_map<TileKey, std::unique_ptr<Tile>, TileKey::Hash> tiles_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  std::array<PendingPoint, 32> pending_points_;
  std::array<Tile*, 64> recent_{};  // tiles of this scan, by hash of their key
  std::vector<StaleBlock> stale_;   // blocks changed by this update
  std::vector<TileKey> sweep_;      // tiles to be written by store_some(), the next one last
  std::size_t sweep_share_ = 0;     // of them per call
  std::vector<TileKey> stored_;     // stored tiles to bring back, the nearest last
  std::size_t restored_ = 0;        // number of tiles read from the storage by this update
  std::vector<std::byte> bytes_;    // scratch
  SeenThrough seen_through_;
  PoseEstimate last_pose_;
  bool started_ = false;
  std::size_t insert_count_ = 0;
  std::uint64_t seen_through_count_ = 0;
};

}  // namespace isobar
