// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <thread>

#include "core/map/map_snapshot.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "core/registration/registration.hpp"
#include "daemon/deadline.hpp"
#include "daemon/realtime.hpp"
#include "daemon/scan_queue.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/silence.hpp"
#include "daemon/worker_watch.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the registration thread says of itself.
struct RegistrationStatus {
  std::uint64_t scans = 0;
  std::uint64_t from_prior = 0;  ///< scans whose registration was refused
  std::uint64_t dropped_scans =
      0;  ///< came faster than they could be registered, or never came; see ScanQueue
  std::uint64_t dropped_priors = 0;
  std::uint64_t bridged = 0;  ///< poses without a scan
  double overlap = 0.0;
  double registration_ms = 0.0;
  PoseMode mode = PoseMode::kInitializing;
  Method effective_method = Method::k3Dof;
  bool degenerate = false;
  DeadlineStatus punctuality;     ///< from the end of a scan to its pose handed on
  std::uint64_t page_faults = 0;  ///< of this thread, since it has found its pace
};

/// Priors and scans in, poses and registered scans out. Every scan gets a pose at its end: from the
/// registration, or from the prior where the scan was dropped because a newer one was there.
class RegistrationThread {
 public:
  RegistrationThread(const RegistrationConfig& config, Method method, const Eigen::Isometry3d& T_base_lidar,
                     SnapshotExchange<MapSnapshot>& snapshots, const ScanQueueConfig& queue,
                     ThreadSettings settings);
  ~RegistrationThread();
  RegistrationThread(const RegistrationThread&) = delete;
  RegistrationThread& operator=(const RegistrationThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] RegistrationStatus status() const noexcept { return status_.get(); }
  void knock() noexcept { waiter_.wake(); }  ///< see WorkerWatch; any thread
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  /// Scans after which everything that is used has been touched once.
  static constexpr std::uint64_t kScansToFindPace = 20;
  /// A thread that looks every 50 ms and has not for so long was held up.
  static constexpr std::int64_t kStoodStillNs = 200'000'000;
  /// Without a scan for so long nothing is on its way.
  static constexpr std::int64_t kQuietNs = 90'000'000;

  void loop() noexcept;
  ipc::Waiter::Event wait() noexcept;
  void drain() noexcept;
  void emit_dropped() noexcept;
  void register_scan(const Scan& scan) noexcept;
  void bridge_silence() noexcept;
  void report() noexcept;
  void emit(const PoseEstimate& pose, bool from_scan) noexcept;

  ThreadSettings settings_;
  Registration registration_;
  SnapshotExchange<MapSnapshot>& snapshots_;
  ipc::Subscriber<Prior> priors_;
  ipc::Subscriber<Scan> scans_;
  ipc::Publisher<PoseEstimate> poses_;
  ipc::Publisher<RegisteredScan> registered_scans_;
  ipc::Waiter waiter_;
  ScanQueue<ipc::Received<Scan>> queue_;
  std::int64_t newest_prior_ns_ = 0;
  std::int64_t last_look_ns_ = 0;                // robot clock
  std::int64_t quiet_since_ns_ = 0;              // robot clock
  std::unique_ptr<RegisteredScan> unpublished_;  ///< used while no chunk is free: the pose still goes out
  std::unique_ptr<Scan> without_points_;         ///< in place of a scan that was dropped
  SilenceBridge silence_;
  Deadline deadline_;
  std::uint64_t faults_before_ = 0;
  RegistrationStatus own_;
  SeqLock<RegistrationStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar
