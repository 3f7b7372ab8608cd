// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/mount_estimator.hpp"

#include <cmath>

#include "core/geometry.hpp"
#include "core/mounts/gyro_turn.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Longest time between two registered scans [s] over which the gyro is integrated.
constexpr double kLongestScanStepS = 2.0;
// A robot without wheels hangs or flies along rough walls: its map tilts as on a way this much longer (simulated shafts).
constexpr double kFreeWayFactor = 9.0;
// Systematic errors, 1 sigma [rad]. Roll and pitch: axes of the gyro, 0.05 deg in data sheets. Yaw from turns that
// tilt: the scans on stairs and ramps. Yaw from straight drives: side slip, axes of the wheels.
constexpr double kTiltFloorRad = 0.05 * kRadPerDeg;
constexpr double kTurnYawFloorRad = 0.3 * kRadPerDeg;
constexpr double kWheelYawFloorRad = 0.07 * kRadPerDeg;
// Systematic error of the scale of the distance: slip differs between floors.
constexpr double kScaleFloor = 0.002;
// Standard deviation at which an angle counts as found.
constexpr double kFoundRad = 0.4 * kRadPerDeg;
// The same of yaw where wheels will tell it better: that of turns that tilt was off by 0.5 deg, as much as hands are.
constexpr double kFoundByWheelsRad = 0.2 * kRadPerDeg;
// Straight stretches from which on their mean is used.
constexpr std::uint32_t kLeastStretches = 4;

ScaleEstimate scale_of(const RunningMean& mean, double floor) {
  const bool known = mean.count() >= kLeastStretches;
  return {known ? mean.mean() : 1.0, std::hypot(mean.sigma_of_mean(), floor)};
}

}  // namespace

MountEstimator::MountEstimator(const Eigen::Quaterniond& q_base_lidar, const MountFilterConfig& config)
    : q_base_lidar_(q_base_lidar.normalized()), filter_(config) {}

void MountEstimator::add(const ScanMotionEvidence& scan, const PriorHistory& history) {
  if (!scan.T_map_base.matrix().allFinite()) return;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Prior prior;
  const bool known = follows(scan) && gyro_turn(history, last_.stamp_ns, scan.stamp_ns, turn) &&
                     history.at(scan.stamp_ns, prior);
  if (!known) {
    begin(scan);
    return;
  }
  const double step_m = (scan.T_map_base.translation() - last_.T_map_base.translation()).norm();
  const double way_m = prior.velocity_valid ? step_m : kFreeWayFactor * step_m;
  filter_.add(seconds_between(last_.stamp_ns, scan.stamp_ns), turn, way_m, configured_attitude(scan));
  compare_wheels(scan, prior, log_so3(turn).z());
  last_ = scan;
}

// R_map_base by the configured mount is R_map_lidar R_base_lidar^T, whatever mount the registration used.
Eigen::Quaterniond MountEstimator::configured_attitude(const ScanMotionEvidence& scan) const {
  const Eigen::Quaterniond q_map_lidar = Eigen::Quaterniond(scan.T_map_base.linear()) * scan.q_base_lidar;
  return (q_map_lidar * q_base_lidar_.conjugate()).normalized();
}

bool MountEstimator::follows(const ScanMotionEvidence& scan) const {
  return started_ && scan.session == last_.session && scan.stamp_ns > last_.stamp_ns &&
         seconds_between(last_.stamp_ns, scan.stamp_ns) <= kLongestScanStepS;
}

void MountEstimator::begin(const ScanMotionEvidence& scan) {
  started_ = true;
  last_ = scan;
  filter_.restart(configured_attitude(scan));
  wheels_.interrupt();
}

void MountEstimator::compare_wheels(const ScanMotionEvidence& scan, const Prior& prior,
                                    double gyro_turn_z_rad) {
  WheelMotion motion;
  motion.q_map_base = filter_.q_map_base_configured();
  motion.p_map_base_m = scan.T_map_base.translation();
  motion.q_odom_base = Eigen::Quaterniond(prior.T_odom_base.linear());
  motion.p_odom_base_m = prior.T_odom_base.translation();
  motion.gyro_turn_z_rad = gyro_turn_z_rad;
  motion.wheel_turn_rad = scan.wheel_turn_rad;
  motion.wheels_valid = prior.velocity_valid;
  has_wheels_ = has_wheels_ || motion.wheels_valid;
  wheels_.add(motion);
}

void MountEstimator::add_level(const LevelEvidence& level) {
  if (level_used_) return;
  level_used_ = true;
  filter_.add_level(level);
}

MountEstimate MountEstimator::estimate() const {
  MountEstimate out;
  out.error_rad = filter_.mount_error_rad();
  out.covariance_rad2 = filter_.covariance_rad2();
  out.covariance_rad2.diagonal() +=
      Eigen::Vector3d(squared(kTiltFloorRad), squared(kTiltFloorRad), squared(kTurnYawFloorRad));
  use_wheels_yaw(out);
  out.outlier_share = filter_.outlier_share();
  out.wheel_distance = scale_of(wheels_.distance_scale(), kScaleFloor);
  out.wheel_turn = scale_of(wheels_.turn_scale(), kScaleFloor);
  const Eigen::Vector3d sigma = out.sigma_rad();
  out.yaw_found = sigma.z() < (has_wheels_ ? kFoundByWheelsRad : kFoundRad);
  if (sigma.head<2>().maxCoeff() < kFoundRad) out.verdict = MountVerdict::kFound;
  if (!filter_.consistent()) out.verdict = MountVerdict::kInconsistent;
  return out;
}

// A Kalman update of the result with the yaw of the wheels, which refers to base_link's x axis: the IMU's own yaw in
// base_link is part of the floor.
void MountEstimator::use_wheels_yaw(MountEstimate& out) const {
  const RunningMean& yaw = wheels_.yaw_rad();
  if (yaw.count() < kLeastStretches) return;
  const double variance = squared(yaw.sigma_of_mean()) + squared(kWheelYawFloorRad);
  const Eigen::Vector3d gain = out.covariance_rad2.col(2) / (out.covariance_rad2(2, 2) + variance);
  out.error_rad += gain * (yaw.mean() - out.error_rad.z());
  out.covariance_rad2 -= (gain * out.covariance_rad2.row(2)).eval();
}

}  // namespace isobar
