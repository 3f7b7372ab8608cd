// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/registration_thread.hpp"

#include <algorithm>

#include "daemon/cpu_time.hpp"

namespace isobar {

RegistrationThread::RegistrationThread(const RegistrationConfig& config, Method method,
                                       const Eigen::Isometry3d& T_base_lidar,
                                       SnapshotExchange<MapSnapshot>& snapshots, ThreadSettings settings)
    : settings_(std::move(settings)),
      registration_(config, method, T_base_lidar),
      snapshots_(snapshots),
      priors_(ipc::topics::kPrior),
      scans_(ipc::topics::kLidarScan),
      poses_(ipc::topics::kPose),
      registered_scans_(ipc::topics::kRegisteredScan),
      waiter_({&priors_.raw(), &scans_.raw()}),
      unpublished_(std::make_unique<RegisteredScan>()) {}

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
  while (waiter_.wait() != ipc::Waiter::Event::kStopped) drain();
  drain();
}

void RegistrationThread::drain() noexcept {
  while (const auto prior = priors_.take()) {
    registration_.add_prior(*prior);
    bridge_silence(*prior);
  }
  while (waiting_count_ < kMaxWaiting) {
    auto scan = scans_.take();
    if (!scan) break;
    waiting_[waiting_count_++] = std::move(scan);
  }
  // A scan waits for the priors up to its end; when the priors stay away, the oldest goes on without.
  while (waiting_count_ > 0 && (waiting_count_ == kMaxWaiting || registration_.ready(*waiting_[0]))) {
    register_oldest();
  }
  own_.dropped_scans = scans_.dropped();
  own_.dropped_priors = priors_.dropped();
  status_.put(own_);
}

void RegistrationThread::register_oldest() noexcept {
  const ipc::Received<Scan> scan = std::move(waiting_[0]);
  std::move(waiting_.begin() + 1, waiting_.end(), waiting_.begin());
  --waiting_count_;

  RegisteredScan* loaned = registered_scans_.loan();
  RegisteredScan& out = loaned != nullptr ? *loaned : *unpublished_;
  const CpuTimer timer;
  {
    const auto snapshot = snapshots_.pin();
    registration_.register_scan(*scan, *snapshot, out);
  }
  out.pose.registration_ms = timer.elapsed_ms();

  ++own_.scans;
  own_.from_prior += out.pose.mode == PoseMode::kPriorOnly ? 1 : 0;
  emit(out.pose, true);
  if (loaned != nullptr) registered_scans_.publish(loaned);
}

void RegistrationThread::bridge_silence(const Prior& newest) noexcept {
  PoseEstimate pose;
  if (!silence_.due(newest.stamp_ns) || !registration_.propagate(pose)) return;
  ++own_.bridged;
  emit(pose, false);
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
