// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/loops/map_mover.hpp"
#include "core/map/local_map.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "daemon/deadline.hpp"
#include "daemon/floor_feed.hpp"
#include "daemon/handover.hpp"
#include "daemon/map_cloud.hpp"
#include "daemon/map_stores.hpp"
#include "daemon/run_start.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the map thread.
struct MapStatus {
  std::uint64_t dropped_scans = 0;  ///< superseded by a newer waiting scan, or lost to a full queue
  std::uint64_t cells = 0;
  bool on_disk = false;  ///< tiles are written
  std::uint64_t tiles_on_disk = 0;
  std::uint64_t disk_bytes = 0;  ///< of the tiles
  bool disk_failing = false;     ///< the last attempt to write tiles failed; the next one is a second later
  double update_ms = 0.0;        ///< CPU time of the last update
  DeadlineStatus punctuality;    ///< from the publication of a pose to the map snapshot with its scan
};

/// Adds registered scans to the local map; publishes immutable snapshots for the registration and clouds for
/// viewers. Not real-time: it allocates, and it alone frees old snapshots.
class MapThread {
 public:
  /// @param maps keeps the tiles; used by this thread only, while it runs
  /// @param floors gets the points of the map; null: nobody wants them. Outlives the thread
  /// @param start the map frame, and the place around which its tiles are read
  MapThread(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, double cloud_interval_s,
            MapStores& maps, const RunStart& start, ThreadSettings settings, FloorFeed* floors = nullptr);

  /// Once stopped, the whole local map is in the store.
  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] SnapshotExchange<MapSnapshot>& snapshots() noexcept { return snapshots_; }
  /// Reads the stored tiles around a place where the robot may be, soon; looked() grows then. The thread that searches the
  /// place.
  void look_at(const Eigen::Vector3d& p_map_m) { places_.offer(std::make_unique<Eigen::Vector3d>(p_map_m)); }
  /// Number of places whose tiles were read. Any thread.
  [[nodiscard]] std::uint64_t looked() const noexcept { return looked_.load(std::memory_order_acquire); }
  /// Changes the settings of the map (see LocalMap::configure()), the interval of its clouds and the deadline,
  /// from the next scan on. Main thread, as collect().
  void configure(const MapConfig& config, double cloud_interval_s, double deadline_ms) {
    changes_.offer(std::make_unique<Change>(Change{config, cloud_interval_s, deadline_ms}));
  }
  void collect() { changes_.collect(); }
  /// Gives the map a successor that was laid anew, and whose folder waits to be put in place. One thread, not necessarily
  /// the main thread.
  void offer(std::unique_ptr<MovedMap> moved) { moved_.offer(std::move(moved)); }

  [[nodiscard]] MapStatus status() const noexcept { return status_.get(); }

 private:
  /// Kinds of tile losses that are already in the log.
  struct LoggedLosses {
    bool refused = false;
    bool damaged = false;
    bool forgotten = false;
  };
  struct Change {
    MapConfig config;
    double cloud_interval_s;
    double deadline_ms;
  };
  void loop() noexcept;
  void drain() noexcept;
  void add(const RegisteredScan& scan) noexcept;
  void begin_session(std::uint32_t session) noexcept;
  void exchange(MovedMap& moved) noexcept;
  void write_tiles() noexcept;
  void store_changed_tiles() noexcept;
  void store_all_tiles() noexcept;
  void follow_folder();
  void log_tile_losses() noexcept;

  MapConfig config_;
  Eigen::Isometry3d T_base_lidar_;
  MapStores& maps_;
  std::unique_ptr<LocalMap> map_;  ///< never null
  SnapshotExchange<MapSnapshot> snapshots_;
  ipc::Subscriber<RegisteredScan> scans_;
  MapCloudPublisher cloud_;
  FloorFeed* floors_;  ///< null: nobody wants the points
  ipc::Waiter waiter_;
  LoggedLosses logged_;
  std::int64_t written_ns_ = 0;   ///< last write_tiles(), robot clock
  bool sweep_whole_ = true;       ///< no tile of the present sweep was refused
  std::uint64_t superseded_ = 0;  ///< scans dropped for a newer one
  Deadline deadline_;
  Handover<Change> changes_;
  Handover<MovedMap> moved_;
  Handover<Eigen::Vector3d> places_;
  std::atomic<std::uint64_t> looked_{0};
  MapStatus draft_status_;
  SeqLock<MapStatus> status_;
  Worker worker_;
};

}  // namespace isobar
