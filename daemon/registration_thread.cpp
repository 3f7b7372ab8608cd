// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/registration_thread.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "daemon/message_loop.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {
namespace {

PoseSummary summary_of(const PoseEstimate& pose) noexcept {
  const Eigen::Vector3d p_map = pose.T_map_base.translation();
  const Eigen::Matrix3d R = pose.T_map_base.linear();
  PoseSummary summary{.stamp_ns = pose.stamp_ns,
                      .p_map_m = {p_map.x(), p_map.y(), p_map.z()},
                      .rpy_rad = {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                                  std::atan2(R(1, 0), R(0, 0))}};
  for (int i = 0; i < 6; ++i) summary.variances[static_cast<std::size_t>(i)] = pose.covariance(i, i);
  return summary;
}

// 1 sigma of x and y is that of the worst direction.
PlaceHint place_hint(const ipc::PoseHint& hint) noexcept {
  const auto variance = [&hint](std::size_t row, std::size_t column) {
    return hint.covariance[6 * row + column];
  };
  const double mean = 0.5 * (variance(0, 0) + variance(1, 1));
  const double spread = std::hypot(0.5 * (variance(0, 0) - variance(1, 1)), variance(0, 1));
  return {.session = hint.session,
          .p_map_m = {hint.x_m, hint.y_m},
          .has_z = hint.has_z,
          .z_m = hint.z_m,
          .z_sigma_m = std::sqrt(std::max(0.0, variance(2, 2))),
          .yaw_rad = hint.yaw_rad,
          .sigma_m = std::sqrt(std::max(0.0, mean + spread)),
          .sigma_rad = std::sqrt(std::max(0.0, variance(5, 5)))};
}

}  // namespace

RegistrationThread::RegistrationThread(const StageSettings& stages, SnapshotExchange<MapSnapshot>& snapshots,
                                       const ScanQueueConfig& queue, ThreadSettings settings)
    : stage_(stages.registration, stages.method, stages.T_base_lidar, *this),
      snapshots_(snapshots),
      priors_(ipc::topics::kPrior),
      scans_(ipc::topics::kLidarScan),
      commands_(ipc::topics::kCommand),
      hints_(ipc::topics::kPoseHint),
      poses_(ipc::topics::kPose),
      registered_scans_(ipc::topics::kRegisteredScan),
      waiter_({&scans_.raw()}),
      queue_(queue),
      unpublished_(std::make_unique<RegisteredScan>()),
      deadline_(settings.deadline_ms),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void RegistrationThread::loop() noexcept {
  drain_until_stopped(
      waiter_, worker_.heartbeat(), [this] { drain(); }, [this] { return timeout(); });
}

// Only scans wake this thread: to wake for hundreds of priors a second would
// cost half as much as the registration. Priors are polled: every 50 ms to
// bridge a silent lidar, every millisecond while a scan waits for them.
std::chrono::nanoseconds RegistrationThread::timeout() const noexcept {
  constexpr std::chrono::milliseconds kPollWithoutScan(50);
  constexpr std::chrono::milliseconds kPollWithScan(1);
  return queue_.empty() ? kPollWithoutScan : kPollWithScan;
}

void RegistrationThread::rebuild(const StageSettings& stages, const ScanQueueConfig& queue,
                                 double deadline_ms) {
  changes_.offer(std::make_unique<Change>(
      Change{std::make_unique<Registration>(stages.registration, stages.method, stages.T_base_lidar), queue,
             deadline_ms}));
}

void RegistrationThread::drain() noexcept {
  changes_.take([this](Change& change) {
    stage_.replace(change.registration);
    queue_.configure(change.queue);
    deadline_.set_limit(change.deadline_ms);
  });
  obey();
  take_hints();
  while (const auto prior = priors_.take()) stage_.add_prior(*prior);
  const std::int64_t now_ns = RobotClock::now_ns();
  bool scan_arrived = false;
  while (auto scan = scans_.take()) {
    draft_status_.last_scan_ns = scan->end_stamp_ns;
    draft_status_.scan_arrivals.add(scan->end_stamp_ns, scan->timing);
    ++draft_status_.arrived_scans;
    queue_.push(std::move(scan), now_ns);
    scan_arrived = true;
  }
  const auto scan = queue_.take(now_ns, stage_.newest_prior_ns());
  skip_dropped();
  if (scan) register_scan(*scan);
  bridge_silence(scan_arrived, now_ns);
  report();
}

// Commands come through shared memory (`isobar reset`) or from a thread of this process.
void RegistrationThread::obey() noexcept {
  NewFrameReason reason = new_frame_.exchange(NewFrameReason::kNone, std::memory_order_relaxed);
  while (const auto message = commands_.take()) {
    if (message->command == ipc::Command::kNewFrame) reason = NewFrameReason::kCommand;
  }
  if (reason == NewFrameReason::kNone) return;
  stage_.begin_new_frame();
  draft_status_.session_reason = reason;
}

// Hints come through shared memory, of `isobar initial-pose` or isobar-dds. The newest counts.
void RegistrationThread::take_hints() noexcept {
  places_.take([this](const PlaceHint& hint) { stage_.offer_place(hint); });
  if (place_given_up_.exchange(false, std::memory_order_relaxed)) stage_.give_up_place();
  while (const auto hint = hints_.take()) {
    if (ipc::implausibility(*hint) != nullptr) {
      ++draft_status_.bad_hints;
    } else {
      stage_.hint(place_hint(*hint));
    }
  }
}

void RegistrationThread::skip_dropped() noexcept {
  for (const DroppedScan& dropped : queue_.dropped()) {
    {
      const auto snapshot = snapshots_.pin();
      stage_.skip_scan(dropped, *snapshot, *unpublished_);
    }
    deadline_.note(dropped.end_stamp_ns, RobotClock::now_ns());
  }
  queue_.forget_dropped();
}

void RegistrationThread::register_scan(const Scan& scan) noexcept {
  RegisteredScan* loaned = registered_scans_.loan();
  RegisteredScan& out = loaned != nullptr ? *loaned : *unpublished_;
  {
    const auto snapshot = snapshots_.pin();
    stage_.register_scan(scan, *snapshot, out);
  }
  ++draft_status_.scans;
  draft_status_.from_prior += out.pose.mode == PoseMode::kPriorOnly ? 1 : 0;
  out.handed_over_ns = RobotClock::now_ns();
  deadline_.note(scan.end_stamp_ns, out.handed_over_ns);
  if (loaned != nullptr) registered_scans_.publish(loaned);
}

// Bridges only while no scan waits: a pose at the newest prior would put the older poses of waiting scans out
// of order. For the same reason not directly after a stall of this thread or of the machine, when scans may
// still be in transit.
void RegistrationThread::bridge_silence(bool scan_arrived, std::int64_t now_ns) noexcept {
  if (scan_arrived || now_ns - last_round_ns_ > kHeldUpNs) quiet_since_ns_ = now_ns;
  last_round_ns_ = now_ns;
  if (!queue_.empty() || now_ns - quiet_since_ns_ < kQuietNs) return;
  if (stage_.bridge_silence()) ++draft_status_.bridged;
}

void RegistrationThread::report() noexcept {
  const std::uint64_t faults = page_faults_of_this_thread();
  if (draft_status_.scans <= kWarmUpScans) warm_up_faults_ = faults;
  draft_status_.page_faults = faults - warm_up_faults_;
  draft_status_.dropped_scans = queue_.dropped_count();
  draft_status_.dropped_priors = priors_.dropped();
  draft_status_.punctuality = deadline_.status();
  const std::uint32_t session = stage_.session();
  const bool told = draft_status_.session_reason == NewFrameReason::kNone;
  if (draft_status_.searching && session != draft_status_.session && told) {
    draft_status_.session_reason = NewFrameReason::kPlaceUnknown;
  }
  draft_status_.session = session;
  draft_status_.searching = stage_.searching();
  draft_status_.hint = stage_.hint_report();
  status_.put(draft_status_);
}

void RegistrationThread::on_pose(const PoseEstimate& pose, const Prior& /*prior*/) noexcept {
  draft_status_.mode = pose.mode;
  draft_status_.map_moves = pose.map_moves;
  draft_status_.effective_method = pose.effective_method;
  draft_status_.overlap = pose.overlap;
  draft_status_.localisability = pose.localisability;
  draft_status_.lost = pose.lost;
  draft_status_.lost_since_ns = pose.lost_since_ns;
  draft_status_.altimeter = pose.altimeter;
  draft_status_.mount = pose.mount;
  draft_status_.registration_ms = pose.registration_ms;
  draft_status_.pose = summary_of(pose);
  poses_.send(pose);
}

}  // namespace isobar
