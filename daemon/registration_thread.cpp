// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/registration_thread.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/cpu_time.hpp"
#include "drivers/datagram/udp.hpp"

namespace isobar {

RegistrationThread::RegistrationThread(const RegistrationConfig& config, Method method,
                                       const Eigen::Isometry3d& T_base_lidar,
                                       SnapshotExchange<MapSnapshot>& snapshots, const ScanQueueConfig& queue,
                                       ThreadSettings settings)
    : settings_(std::move(settings)),
      registration_(config, method, T_base_lidar),
      snapshots_(snapshots),
      priors_(ipc::topics::kPrior),
      scans_(ipc::topics::kLidarScan),
      poses_(ipc::topics::kPose),
      registered_scans_(ipc::topics::kRegisteredScan),
      waiter_({&scans_.raw()}),
      queue_(queue),
      unpublished_(std::make_unique<RegisteredScan>()),
      without_points_(std::make_unique<Scan>()),
      deadline_(settings_.deadline_ms) {}

RegistrationThread::~RegistrationThread() { stop(); }

void RegistrationThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void RegistrationThread::stop() noexcept {
  waiter_.stop();
  if (thread_.joinable()) thread_.join();
}

void RegistrationThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  while (wait() != ipc::Waiter::Event::kStopped) {
    heartbeat_.beat();
    drain();
  }
  drain();
}

// A scan wakes this thread, a prior does not: to wake for hundreds of them a second would cost as much as
// half of the registrations. They are looked at now and then, for the time without scans, and closely while a
// scan waits.
ipc::Waiter::Event RegistrationThread::wait() noexcept {
  constexpr std::chrono::milliseconds kWithoutScan(50);
  constexpr std::chrono::milliseconds kWithScan(1);
  return waiter_.wait_for(queue_.empty() ? kWithoutScan : kWithScan);
}

void RegistrationThread::drain() noexcept {
  while (const auto prior = priors_.take()) {
    registration_.add_prior(*prior);
    newest_prior_ns_ = std::max(newest_prior_ns_, prior->stamp_ns);
  }
  const std::int64_t now_ns = RobotClock::now_ns();
  bool came = false;
  while (auto scan = scans_.take()) {
    queue_.push(std::move(scan), now_ns);
    came = true;
  }
  const auto scan = queue_.take(now_ns, newest_prior_ns_);
  emit_dropped();
  if (scan) register_scan(*scan);
  // After the scans, which are older: a pose from the newest prior would make theirs come too late. For the
  // same reason never just after this thread, or the whole machine, stood still: scans may be on their way.
  if (came || now_ns - last_look_ns_ > kStoodStillNs) quiet_since_ns_ = now_ns;
  last_look_ns_ = now_ns;
  if (queue_.empty() && now_ns - quiet_since_ns_ >= kQuietNs) bridge_silence();
  report();
}

// A scan without its points: the motion goes on, and the pose is the prior's.
void RegistrationThread::emit_dropped() noexcept {
  for (const DroppedScan& dropped : queue_.dropped()) {
    without_points_->stamp_ns = without_points_->end_stamp_ns = dropped.end_stamp_ns;
    without_points_->sequence = dropped.sequence;
    {
      const auto snapshot = snapshots_.pin();
      registration_.register_scan(*without_points_, *snapshot, *unpublished_);
    }
    unpublished_->pose.registration_ms = 0.0;
    emit(unpublished_->pose, true);
    deadline_.note(dropped.end_stamp_ns, RobotClock::now_ns());
  }
  queue_.forget_dropped();
}

void RegistrationThread::register_scan(const Scan& scan) noexcept {
  RegisteredScan* loaned = registered_scans_.loan();
  RegisteredScan& out = loaned != nullptr ? *loaned : *unpublished_;
  const CpuTimer timer;
  {
    const auto snapshot = snapshots_.pin();
    registration_.register_scan(scan, *snapshot, out);
  }
  out.pose.registration_ms = timer.elapsed_ms();

  ++own_.scans;
  own_.from_prior += out.pose.mode == PoseMode::kPriorOnly ? 1 : 0;
  emit(out.pose, true);
  out.handed_over_ns = RobotClock::now_ns();
  deadline_.note(scan.end_stamp_ns, out.handed_over_ns);
  if (loaned != nullptr) registered_scans_.publish(loaned);
}

void RegistrationThread::bridge_silence() noexcept {
  PoseEstimate pose;
  if (!silence_.due(newest_prior_ns_) || !registration_.propagate(pose)) return;
  ++own_.bridged;
  emit(pose, false);
}

void RegistrationThread::report() noexcept {
  const std::uint64_t faults = page_faults_of_this_thread();
  if (own_.scans <= kScansToFindPace) faults_before_ = faults;
  own_.page_faults = faults - faults_before_;
  own_.dropped_scans = queue_.dropped_count();
  own_.dropped_priors = priors_.dropped();
  own_.punctuality = deadline_.status();
  status_.put(own_);
}

void RegistrationThread::emit(const PoseEstimate& pose, bool from_scan) noexcept {
  if (!silence_.in_order(pose.stamp_ns)) return;
  silence_.posed(pose.stamp_ns, from_scan);
  own_.mode = pose.mode;
  own_.effective_method = pose.effective_method;
  own_.overlap = pose.overlap;
  own_.degenerate = pose.degenerate;
  own_.registration_ms = pose.registration_ms;
  poses_.send(pose);
}

}  // namespace isobar
