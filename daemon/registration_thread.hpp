// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>

#include "core/map/map_snapshot.hpp"
#include "core/map/snapshot_exchange.hpp"
#include "core/name_table.hpp"
#include "daemon/arrival_meter.hpp"
#include "daemon/deadline.hpp"
#include "daemon/handover.hpp"
#include "daemon/registration_stage.hpp"
#include "daemon/run_start.hpp"
#include "daemon/scan_queue.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/stage_settings.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// The newest pose of base_link in the map frame, registered or from the prior.
struct PoseSummary {
  std::int64_t stamp_ns = 0;  ///< robot clock; 0: none yet
  std::array<double, 3> p_map_m{};
  std::array<double, 3> rpy_rad{};    ///< roll, pitch, yaw
  std::array<double, 6> variances{};  ///< of x, y, z [m^2], roll, pitch, yaw [rad^2]
};

/// Why a map frame was begun.
enum class NewFrameReason : std::uint8_t {
  kNone,             ///< the first of the run, or the continued one
  kPlaceUnknown,     ///< a continued run does not find its place in its map
  kCommand,          ///< somebody asked for it
  kInputStartsOver,  ///< the sensors' clock has jumped back: another recording is played
  kContradiction     ///< a sensor contradicts the configuration or the others, and is left out from here on
};

inline constexpr NameTable<NewFrameReason, 5> kNewFrameReasonNames{{{
    {NewFrameReason::kNone, "none"},
    {NewFrameReason::kPlaceUnknown, "the place is not that of the map"},
    {NewFrameReason::kCommand, "on command"},
    {NewFrameReason::kInputStartsOver, "the input started over"},
    {NewFrameReason::kContradiction, "a sensor was left out: its samples contradict the others"},
}}};

/// Status of the registration thread.
struct RegistrationStatus {
  std::uint64_t scans = 0;
  std::uint64_t from_prior = 0;  ///< scans whose registration was refused
  std::uint64_t dropped_scans =
      0;  ///< scans superseded by a newer one, or lost before this thread; see ScanQueue
  std::uint64_t dropped_priors = 0;
  std::int64_t last_scan_ns = 0;  ///< end of the newest scan that arrived, robot clock; 0: none yet
  ArrivalMeter scan_arrivals;     ///< of scans that isobar-dds received
  std::uint64_t arrived_scans = 0;
  std::uint64_t bridged = 0;                              ///< poses without a scan
  std::uint32_t session = 1;                              ///< number of the map frame
  NewFrameReason session_reason = NewFrameReason::kNone;  ///< why it was begun
  std::uint32_t map_moves = 0;                            ///< of it, see PoseEstimate
  bool searching = false;                                 ///< a continued run has not found its place yet
  double overlap = 0.0;
  double registration_ms = 0.0;
  PoseMode mode = PoseMode::kInitializing;
  Method effective_method = Method::k3Dof;
  Localisability localisability;
  LostReason lost = LostReason::kNone;  ///< of the last pose
  std::int64_t lost_since_ns = 0;
  AltimeterState altimeter;  ///< adaptive method only, as the next one
  MountState mount;
  HintReport hint;              ///< the last hint of where the robot is
  std::uint64_t bad_hints = 0;  ///< hints that were implausible
  PoseSummary pose;
  DeadlineStatus punctuality;     ///< from the end of a scan to the publication of its pose
  std::uint64_t page_faults = 0;  ///< of this thread, after warm-up
};

/// Runs the RegistrationStage on scans and priors from shared memory; publishes
/// poses and registered scans. Every scan gets a pose at its end: from the
/// registration, or from the prior where a newer scan superseded it.
class RegistrationThread final : private EstimateSink {
 public:
  RegistrationThread(const StageSettings& stages, SnapshotExchange<MapSnapshot>& snapshots,
                     const ScanQueueConfig& queue, ThreadSettings settings);

  /// Begins with a map frame, or continues in a known one. Before the start.
  void begin_at(const RunStart& start) { stage_.begin_at(start.session, start.place); }
  /// See Registration. Before the start.
  void wait_for_place() { stage_.wait_for_place(true); }
  void stay_in(const KnownPlace& place) { stage_.stay_in(place); }
  /// The search of the place has found it, or gives it up. The thread that searches.
  void offer_place(const PlaceHint& hint) { places_.offer(std::make_unique<PlaceHint>(hint)); }
  void give_up_place() noexcept { place_given_up_.store(true, std::memory_order_relaxed); }
  /// Begins a new map frame with the next scan; the old map and trajectory are kept. Any thread.
  void begin_new_frame(NewFrameReason reason) noexcept {
    new_frame_.store(reason, std::memory_order_relaxed);
  }

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  /// Builds the registration anew with other settings; before the next scan it replaces the one in use, whose
  /// pose it continues. Main thread, as collect().
  void rebuild(const StageSettings& stages, const ScanQueueConfig& queue, double deadline_ms);
  void collect() { changes_.collect(); }

  [[nodiscard]] RegistrationStatus status() const noexcept { return status_.get(); }

 private:
  /// Warm-up, after which every page in use has been touched once; page faults are counted from its end.
  static constexpr std::uint64_t kWarmUpScans = 20;
  /// Pause between two rounds beyond which this thread, which polls every 50 ms, counts as stalled.
  static constexpr std::int64_t kHeldUpNs = 200'000'000;
  /// Time without a scan after which no scan is in transit.
  static constexpr std::int64_t kQuietNs = 90'000'000;

  struct Change {
    std::unique_ptr<Registration> registration;
    ScanQueueConfig queue;
    double deadline_ms;
  };
  void loop() noexcept;
  [[nodiscard]] std::chrono::nanoseconds timeout() const noexcept;
  void drain() noexcept;
  void obey() noexcept;
  void take_hints() noexcept;
  void skip_dropped() noexcept;
  void register_scan(const Scan& scan) noexcept;
  void bridge_silence(bool scan_arrived, std::int64_t now_ns) noexcept;
  void report() noexcept;
  void on_pose(const PoseEstimate& pose, const Prior& prior) noexcept override;

  RegistrationStage stage_;
  SnapshotExchange<MapSnapshot>& snapshots_;
  ipc::Subscriber<Prior> priors_;
  ipc::Subscriber<Scan> scans_;
  ipc::Subscriber<ipc::CommandMessage> commands_;
  ipc::Subscriber<ipc::PoseHint> hints_;
  ipc::Publisher<PoseEstimate> poses_;
  ipc::Publisher<RegisteredScan> registered_scans_;
  ipc::Waiter waiter_;
  ScanQueue<ipc::Received<Scan>> queue_;
  std::int64_t last_round_ns_ = 0;               // robot clock
  std::int64_t quiet_since_ns_ = 0;              // robot clock
  std::unique_ptr<RegisteredScan> unpublished_;  ///< used while no chunk is free: the pose is still published
  Deadline deadline_;
  Handover<Change> changes_;
  Handover<PlaceHint> places_;
  std::atomic<bool> place_given_up_{false};
  std::atomic<NewFrameReason> new_frame_{NewFrameReason::kNone};  ///< asked for; kNone: not
  std::uint64_t warm_up_faults_ = 0;
  RegistrationStatus draft_status_;
  SeqLock<RegistrationStatus> status_;
  Worker worker_;
};

}  // namespace isobar
