// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <thread>

#include "core/map/map_snapshot.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "core/registration/registration.hpp"
#include "daemon/mailbox.hpp"
#include "daemon/realtime.hpp"
#include "daemon/silence.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the registration thread says of itself.
struct RegistrationStatus {
  std::uint64_t scans = 0;
  std::uint64_t from_prior = 0;     ///< scans whose registration was refused
  std::uint64_t dropped_scans = 0;  ///< came faster than they could be registered
  std::uint64_t dropped_priors = 0;
  std::uint64_t bridged = 0;  ///< poses without a scan
  double overlap = 0.0;
  double registration_ms = 0.0;
  PoseMode mode = PoseMode::kInitializing;
  Method effective_method = Method::k3Dof;
  bool degenerate = false;
};

/// Priors and scans in, poses and registered scans out.
class RegistrationThread {
 public:
  RegistrationThread(const RegistrationConfig& config, Method method, const Eigen::Isometry3d& T_base_lidar,
                     SnapshotExchange<MapSnapshot>& snapshots, ThreadSettings settings);
  ~RegistrationThread();
  RegistrationThread(const RegistrationThread&) = delete;
  RegistrationThread& operator=(const RegistrationThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] RegistrationStatus status() const noexcept { return status_.get(); }

 private:
  static constexpr std::size_t kMaxWaiting = 3;  ///< one less than the queue is deep: it keeps a place free

  void loop() noexcept;
  void drain() noexcept;
  void register_oldest() noexcept;
  void bridge_silence(const Prior& newest) noexcept;
  void emit(const PoseEstimate& pose, bool from_scan) noexcept;

  ThreadSettings settings_;
  Registration registration_;
  SnapshotExchange<MapSnapshot>& snapshots_;
  ipc::Subscriber<Prior> priors_;
  ipc::Subscriber<Scan> scans_;
  ipc::Publisher<PoseEstimate> poses_;
  ipc::Publisher<RegisteredScan> registered_scans_;
  ipc::Waiter waiter_;
  std::array<ipc::Received<Scan>, kMaxWaiting> waiting_;
  std::size_t waiting_count_ = 0;
  std::unique_ptr<RegisteredScan> unpublished_;  ///< used while no chunk is free: the pose still goes out
  SilenceBridge silence_;
  RegistrationStatus own_;
  Mailbox<RegistrationStatus> status_;
  std::thread thread_;
};

}  // namespace isobar
