// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <thread>
#include <vector>

#include "core/map/local_map.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "daemon/deadline.hpp"
#include "daemon/realtime.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker_watch.hpp"
#include "ipc/shared_memory.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// What the map thread says of itself.
struct MapStatus {
  std::uint64_t dropped_scans = 0;  ///< older than the newest that waited, or lost on the way
  std::uint64_t cells = 0;
  double update_ms = 0.0;      ///< CPU time of the last update
  DeadlineStatus punctuality;  ///< from a pose handed on to the map that holds its scan
};

/// Registered scans in; immutable snapshots for the registration and clouds for viewers out. Not real-time:
/// it allocates, and it is the one that frees old snapshots.
class MapThread {
 public:
  /// `store` may be null; else it keeps the tiles that leave the local map, used by this thread only between
  /// start() and stop().
  MapThread(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar, double cloud_interval_s,
            FileTileStore* store, ThreadSettings settings);
  ~MapThread();
  MapThread(const MapThread&) = delete;
  MapThread& operator=(const MapThread&) = delete;

  void start();
  /// Returns when the thread has ended; what is in the local map has gone to the store then.
  void stop() noexcept;

  [[nodiscard]] SnapshotExchange<MapSnapshot>& snapshots() noexcept { return snapshots_; }
  [[nodiscard]] MapStatus status() const noexcept { return status_.get(); }
  void knock() noexcept { waiter_.wake(); }  ///< see WorkerWatch; any thread
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  /// What the log already has of the store.
  struct Said {
    bool refused = false;
    bool damaged = false;
    bool forgotten = false;
  };
  void loop() noexcept;
  void drain() noexcept;
  void add(const RegisteredScan& scan) noexcept;
  void say_what_is_lost() noexcept;
  void publish_cloud(std::int64_t stamp_ns) noexcept;

  ThreadSettings settings_;
  LocalMap map_;
  SnapshotExchange<MapSnapshot> snapshots_;
  ipc::Subscriber<RegisteredScan> scans_;
  ipc::Publisher<ipc::MapCloud> clouds_;
  ipc::Waiter waiter_;
  FileTileStore* store_;
  Said said_;
  std::int64_t cloud_interval_ns_;
  std::int64_t last_cloud_ns_ = 0;
  std::uint32_t cloud_sequence_ = 0;
  std::vector<MapPoint> points_;  ///< scratch
  std::uint64_t overtaken_ = 0;   ///< scans that a newer one overtook
  Deadline deadline_;
  MapStatus own_;
  SeqLock<MapStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar
