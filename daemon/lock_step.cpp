// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lock_step.hpp"

#include "daemon/cpu_time.hpp"

namespace isobar {

namespace {

// A scan waits for the inertial samples up to its end. More scans than this wait only when the IMU is silent:
// then the oldest is registered with what is known.
constexpr std::size_t kMaxWaitingScans = 4;

}  // namespace

LockStep::LockStep(const StageSettings& settings, EstimateSink& sink)
    : sink_(sink),
      decoder_(settings.lidar),
      prior_estimator_(settings.prior),
      registration_(settings.registration, settings.method, settings.T_base_lidar),
      map_(settings.map, settings.T_base_lidar),
      filling_(std::make_unique<Scan>()) {}

void LockStep::handle(const recording::Event& event) {
  switch (event.kind) {
    case recording::EventKind::kLidarPacket:
      take_packet(event);
      break;
    case recording::EventKind::kImu:
      take_imu(event.imu);
      break;
    case recording::EventKind::kPressure:
      prior_estimator_.add_pressure(event.pressure);
      break;
    case recording::EventKind::kBasePressure:
      prior_estimator_.add_base_pressure(event.pressure);
      break;
    case recording::EventKind::kWheel:
      prior_estimator_.add_wheel(event.wheel);
      break;
  }
}

void LockStep::finish() {
  if (decoder_.flush(*filling_)) queue_scan();
  register_waiting(true);
  evicted_.clear();
  map_.append_points(evicted_);
  sink_.on_evicted(evicted_);
}

void LockStep::take_packet(const recording::Event& event) {
  if (decoder_.add_packet(event.packet, event.stamp_ns, *filling_).scan_complete) {
    queue_scan();
    register_waiting(false);
  }
}

void LockStep::take_imu(const ImuSample& sample) {
  Prior prior;
  if (!prior_estimator_.add_imu(sample, prior)) return;
  newest_prior_ = prior;
  registration_.add_prior(prior);
  register_waiting(false);
  bridge_silence();
}

void LockStep::queue_scan() {
  waiting_.push_back(std::move(filling_));
  if (spare_.empty()) {
    filling_ = std::make_unique<Scan>();
  } else {
    filling_ = std::move(spare_.back());
    spare_.pop_back();
  }
}

void LockStep::register_waiting(bool even_without_prior) {
  while (!waiting_.empty() && (even_without_prior || waiting_.size() > kMaxWaitingScans ||
                               registration_.ready(*waiting_.front()))) {
    register_oldest();
  }
}

void LockStep::register_oldest() {
  std::unique_ptr<Scan> scan = std::move(waiting_.front());
  waiting_.pop_front();
  const CpuTimer timer;
  registration_.register_scan(*scan, *map_.snapshot(), registered_);
  registered_.pose.registration_ms = timer.elapsed_ms();
  spare_.push_back(std::move(scan));
  ++scans_;
  emit(registered_.pose, true);

  map_.update(registered_);
}

void LockStep::bridge_silence() {
  PoseEstimate pose;
  if (silence_.due(newest_prior_.stamp_ns) && registration_.propagate(pose)) emit(pose, false);
}

void LockStep::emit(const PoseEstimate& pose, bool from_scan) {
  if (!silence_.in_order(pose.stamp_ns)) return;
  silence_.posed(pose.stamp_ns, from_scan);
  sink_.on_pose(pose, newest_prior_);
}

}  // namespace isobar
