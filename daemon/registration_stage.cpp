// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/registration_stage.hpp"

#include "daemon/cpu_time.hpp"

namespace isobar {

RegistrationStage::RegistrationStage(const RegistrationConfig& config, Method method,
                                     const Eigen::Isometry3d& T_base_lidar, EstimateSink& sink)
    : registration_(std::make_unique<Registration>(config, method, T_base_lidar)),
      sink_(sink),
      without_points_(std::make_unique<Scan>()) {}

void RegistrationStage::begin_at(std::uint32_t session, const std::optional<KnownPlace>& place) {
  registration_->set_session(session);
  if (place) registration_->resume(*place);
}

// The clock may have started over: poses of the new frame need not be newer than the last one.
void RegistrationStage::begin_new_frame() {
  registration_->begin_new_frame();
  newest_prior_ = {};
  silence_ = {};
}

void RegistrationStage::add_prior(const Prior& prior) {
  newest_prior_ = prior;
  registration_->add_prior(prior);
}

void RegistrationStage::register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out) {
  const CpuTimer timer;
  registration_->register_scan(scan, map, out);
  out.pose.registration_ms = timer.elapsed_ms();
  silence_.scanned(out.pose.stamp_ns);
  if (silence_.in_order(out.pose.stamp_ns)) {
    emit(out.pose, true);
  } else {
    emit_late(out.pose);
  }
}

// A pose of the prior is newer than this scan, as at the beginning of a slow lidar: the scan's pose, carried on to
// the newest prior.
void RegistrationStage::emit_late(const PoseEstimate& of_scan) {
  PoseEstimate now;
  if (!registration_->propagate(now)) return;
  PoseEstimate carried = of_scan;
  carried.stamp_ns = now.stamp_ns;
  carried.T_map_base = now.T_map_base;
  carried.T_map_odom = now.T_map_odom;
  carried.covariance = now.covariance;
  emit(carried, true);
}

// A scan without points: Registration predicts the motion up to its end, and the pose is the prior's.
void RegistrationStage::skip_scan(const DroppedScan& scan, const MapSnapshot& map, RegisteredScan& scratch) {
  without_points_->stamp_ns = without_points_->end_stamp_ns = scan.end_stamp_ns;
  without_points_->sequence = scan.sequence;
  registration_->register_scan(*without_points_, map, scratch);
  scratch.pose.registration_ms = 0.0;
  silence_.scanned(scratch.pose.stamp_ns);
  emit(scratch.pose, true);
}

bool RegistrationStage::bridge_silence() {
  PoseEstimate pose;
  if (!silence_.due(newest_prior_.stamp_ns) || !registration_->propagate(pose)) return false;
  emit(pose, false);
  return true;
}

void RegistrationStage::emit(const PoseEstimate& pose, bool from_scan) {
  if (!silence_.in_order(pose.stamp_ns)) return;
  silence_.posed(pose.stamp_ns, from_scan);
  sink_.on_pose(pose, newest_prior_);
}

}  // namespace isobar
