// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that only the adaptive method has: gravity's offset, the lidar's mount, the owner of height.
//
//     at rest: level surfaces ─▶ TiltOffset ─▶ start of the map
//     each scan: MountEstimator ─▶ mount;  MapHeight ─▶ rides;  TiltOffset ─▶ prior ─▶ ICP ─▶ all three
#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/registration/halt.hpp"
#include "core/registration/registration.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Time at rest in which gravity settles and level surfaces are looked for [s].
constexpr double kLevelS = 2.5;

// The variance of gravity's direction is mostly the accelerometer's bias, which is constant and part of the offset. What
// exceeds it comes from motion that the filter could not tell from gravity.
double moving_part(double roll_pitch_variance_rad2) {
  constexpr double kBiasRad = 0.3 * kRadPerDeg;
  return std::max(0.0, roll_pitch_variance_rad2 - squared(kBiasRad));
}

Eigen::Vector3d up_of(const Prior& prior) { return prior.T_odom_base.linear().row(2).transpose(); }

// Direction of the accelerometer's mean force, unit vector in base_link. Against it the offset is constant; the attitude
// filter learns the bias of the accelerometer, by tenths of a degree in the first minutes, and its up moves with that.
Eigen::Vector3d up_force_of(const Prior& prior) {
  return (kGravity * up_of(prior) + prior.accel_bias_m_s2).normalized();
}

// The offset of the mean force as an offset of the attitude filter's up.
Eigen::Vector3d offset_of_attitude(const Prior& prior, const Eigen::Vector3d& offset_of_force_rad) {
  return up_of(prior).cross(up_force_of(prior)) + offset_of_force_rad;
}

}  // namespace

// Looks for level surfaces while the robot stands: what they say of gravity's offset must be known before the map
// begins, which cannot be tilted afterwards. False while the halt lasts and scans are missing.
bool Registration::find_level(const Scan& scan, const Prior& prior, RegisteredScan& out) {
  if (!halts(prior)) {
    state_.tilt.restart(prior.roll_pitch_variance_rad2);
    state_.motion.start(prior, offset_of_attitude(prior, state_.tilt.offset_rad()));
    return true;
  }
  if (state_.level_since_ns == 0) {
    state_.level_since_ns = prior.stamp_ns;
    level_.clear();
  }
  ScanMotion still;
  still.end = prior;
  prepare_scan(scan, state_.history, still, deskewer_, sampler_, out);
  level_.add({out.points, out.point_count});
  out.point_count = 0;
  if (seconds_between(state_.level_since_ns, prior.stamp_ns) < kLevelS) return false;
  const Eigen::Vector3d up_base = up_of(prior);
  const auto level = level_.find(up_base, prior.roll_pitch_variance_rad2);
  state_.tilt.restart(prior.roll_pitch_variance_rad2);
  if (level) {
    state_.tilt.restart_on_level(level->surfaces_covariance_rad2.topLeftCorner<2, 2>());
  }
  state_.motion.start(prior, level ? level->up_by_gravity.cross(level->up_by_surfaces)
                                   : offset_of_attitude(prior, state_.tilt.offset_rad()));
  return true;
}

Prediction Registration::predict(const Prior& end, const MethodTraits& traits) {
  Prediction prediction =
      state_.motion.predict(end, traits,
                            {.offset_rad = offset_of_attitude(end, state_.tilt.offset_rad()),
                             .sigma_rad = state_.tilt.offset_sigma_rad()});
  if (traits.method != Method::kAdaptive) return prediction;
  MapHeight& height = state_.height;
  height.advance_to(end.stamp_ns, state_.history);
  const Eigen::Vector3d up(0.0, 0.0, height.take_risen_m());
  prediction.T_map_base.pretranslate(up);
  prediction.T_map_odom.pretranslate(up);
  prediction.deviation(5) = std::hypot(prediction.deviation(5), std::sqrt(height.unconfirmed_variance_m2()));
  return prediction;
}

// What a scan says of gravity's offset, the mount and the height, and what they say of its pose.
void Registration::learn(const Prior& end, const Prediction& prediction, const MethodTraits& traits,
                         bool registered, PoseEstimate& pose) {
  const bool adaptive = traits.method == Method::kAdaptive;
  if (registered && adaptive) own_tilt(end, pose);
  if (registered) learn_mount(end, traits, pose);
  if (!adaptive) return;
  own_height(prediction, registered, pose);
  describe_mount(pose);
}

// The other methods use no mount; the error that this costs them is in their covariance.
void Registration::learn_mount(const Prior& end, const MethodTraits& traits, const PoseEstimate& pose) {
  ScanMotionEvidence evidence;
  evidence.stamp_ns = pose.stamp_ns;
  // A hint that was taken is no motion.
  evidence.session = pose.session + ((state_.hint.relocations() + pose.map_moves) << 16U);
  evidence.T_map_base = pose.T_map_base;
  evidence.q_base_lidar = state_.q_base_lidar;
  if (end.velocity_valid) evidence.wheel_turn_rad = end.wheel_turn_rad - state_.wheel_turn_rad;
  state_.wheel_turn_rad = end.wheel_turn_rad;
  const bool tilt_shown = traits.tilt != Constraint::kFixed;
  MountEstimator& mounts = tilt_shown ? state_.mounts : state_.yaw_mounts;
  mounts.add(evidence, state_.history);
  state_.mount_doubt.learn(mounts.estimate(), tilt_shown);
}

void Registration::describe_mount(PoseEstimate& pose) const {
  const MountEstimate found = state_.mounts.estimate();
  const auto scale = [](const ScaleEstimate& s) {
    return std::isfinite(s.sigma) ? WheelScale{s.scale, s.sigma} : WheelScale{};
  };
  pose.mount.found = found.verdict == MountVerdict::kFound;
  pose.mount.yaw_found = found.yaw_found;
  Eigen::Map<Eigen::Vector3d>(pose.mount.error_rad.data()) = found.error_rad;
  Eigen::Map<Eigen::Vector3d>(pose.mount.sigma_rad.data()) = found.sigma_rad();
  pose.mount.wheel_distance = scale(found.wheel_distance);
  pose.mount.wheel_turn = scale(found.wheel_turn);
}

// The mount found so far, for the next scan: base_link turns in the map, the lidar stays where it is.
void Registration::use_mount() {
  const MountEstimate found = state_.mounts.estimate();
  Eigen::Vector3d error_rad = Eigen::Vector3d::Zero();
  if (found.verdict == MountVerdict::kFound) {
    error_rad.head<2>() = found.error_rad.head<2>();
    if (found.yaw_found) error_rad.z() = found.error_rad.z();
  }
  const Eigen::Quaterniond q_base_lidar =
      (exp_so3(error_rad) * Eigen::Quaterniond(T_base_lidar_.linear())).normalized();
  const Eigen::Quaterniond turn = q_base_lidar * state_.q_base_lidar.conjugate();
  state_.q_base_lidar = q_base_lidar;
  state_.motion.turn_base(turn.toRotationMatrix());
  state_.tilt.turn_base(log_so3(turn));
  Eigen::Isometry3d T_base_lidar = T_base_lidar_;
  T_base_lidar.linear() = q_base_lidar.toRotationMatrix();
  deskewer_.set_mount(T_base_lidar);
}

void Registration::own_tilt(const Prior& end, PoseEstimate& pose) {
  const Eigen::Vector3d step_m = pose.T_map_base.translation() - state_.last.T_map_base.translation();
  const double dt_s = std::clamp(seconds_between(state_.last.stamp_ns, pose.stamp_ns), 0.0, 1.0);
  state_.tilt.add(
      pose.T_map_base.linear(), up_force_of(end), dt_s, step_m.norm(),
      moving_part(end.roll_pitch_variance_rad2),
      squared(gravity_sigma_rad(config_.gravity_error_deg * kRadPerDeg, state_.tilt.offset_sigma_rad())));
}

// Height of the adaptive method: the scan's, less the error of the map's height as far as the altimeter knows it.
void Registration::own_height(const Prediction& prediction, bool registered, PoseEstimate& pose) {
  MapHeight& height = state_.height;
  const double moved_m =
      (pose.T_map_base.translation() - state_.last.T_map_base.translation()).head<2>().norm();
  const double step_m =
      height.update(pose.T_map_base.translation().z(), moved_m, squared(prediction.deviation(5)), registered,
                    {state_.tilt.tilt_variance_rad2(), state_.tilt.tilt_rad2()});
  const Eigen::Vector3d up(0.0, 0.0, step_m);
  pose.T_map_base.pretranslate(up);
  pose.T_map_odom.pretranslate(up);
  pose.altimeter = height.altimeter();
}

}  // namespace isobar
