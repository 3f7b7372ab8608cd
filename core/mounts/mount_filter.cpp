// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/mount_filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Attitude in a map where the robot has not been registered yet, 1 sigma [rad]: the first scan itself says it.
constexpr double kUnknownAttitudeRad = 0.05;
// Share of the newest scan in the measured noise: a scan far off counts little at once.
constexpr double kNewestShare = 0.3;
// Innovation beyond which a scan is an outlier, in standard deviations; for the gate over three axes, squared.
constexpr double kOutlierSigmas = 3.0;
// Time of the mean of outliers [s].
constexpr double kOutlierTimeS = 30.0;
// Share of outliers at which scans and gyro contradict each other. Good registrations have up to 0.35 for a while
// (elevators), lost ones more than 0.5.
constexpr double kInconsistentShare = 0.45;
// Turn below which the axis of the turn is noise [rad].
constexpr double kLeastTurnRad = 1e-6;

}  // namespace

MountFilter::MountFilter(const MountFilterConfig& config) : config_(config) {
  P_.diagonal().head<3>().setConstant(squared(config.mount_sigma_rad));
}

void MountFilter::restart(const Eigen::Quaterniond& q_map_base_scan) {
  started_ = true;
  q_map_base_ = q_map_base_scan * q_mount_.conjugate();
  P_.topRightCorner<3, 3>().setZero();
  P_.bottomLeftCorner<3, 3>().setZero();
  P_.bottomRightCorner<3, 3>() = squared(kUnknownAttitudeRad) * Eigen::Matrix3d::Identity();
}

void MountFilter::add(double dt_s, const Eigen::Quaterniond& turn, double way_m,
                      const Eigen::Quaterniond& q_map_base_scan) {
  const Eigen::Vector3d turn_rad = log_so3(turn);
  q_map_base_ = (q_map_base_ * turn).normalized();
  predict(dt_s, turn_rad, way_m);

  // Residual in the axes of the configured base; a left error de of q_mount shows there as q_mount^T de.
  const Eigen::Quaterniond q_predicted = q_map_base_configured();
  const Eigen::Vector3d residual = log_so3((q_predicted.conjugate() * q_map_base_scan).normalized());
  Eigen::Matrix<double, 3, 6> H;
  H << q_mount_.toRotationMatrix().transpose(), q_predicted.toRotationMatrix().transpose();
  const Eigen::Matrix3d predicted = H * P_ * H.transpose();
  watch(dt_s, residual, predicted);

  Eigen::Matrix3d R = noise(dt_s, turn_rad);
  const double beyond = residual.dot((predicted + R).inverse() * residual) / squared(kOutlierSigmas);
  if (beyond > 1.0) R *= beyond;
  const Eigen::Matrix3d S = predicted + R;
  Eigen::Matrix<double, 6, 3> K = P_ * H.transpose() * S.inverse();
  if (!consistent()) K.topRows<3>().setZero();  // a registration that is lost tells nothing about the mount
  apply(K * residual);
  // Joseph form, valid for any gain.
  const Matrix6 I_KH = Matrix6::Identity() - K * H;
  P_ = (I_KH * P_ * I_KH.transpose() + K * R * K.transpose()).eval();
}

void MountFilter::predict(double dt_s, const Eigen::Vector3d& turn_rad, double way_m) {
  const double variance =
      squared(config_.gyro_walk_rad_sqrt_s) * dt_s + squared(config_.map_tilt_walk_rad_sqrt_m) * way_m;
  P_.bottomRightCorner<3, 3>().diagonal().array() += variance;
  const Eigen::Vector3d turn_map = q_map_base_ * turn_rad;
  const double turn = turn_map.norm();
  if (turn < kLeastTurnRad) return;
  P_.bottomRightCorner<3, 3>() += squared(config_.gyro_scale_walk) / turn * turn_map * turn_map.transpose();
}

// A registration that is lost, or a moving ground, is noisier than the filter believes.
void MountFilter::watch(double dt_s, const Eigen::Vector3d& residual, const Eigen::Matrix3d& predicted) {
  const double tilt_rad2 = 0.5 * residual.head<2>().squaredNorm();
  const double known_rad2 = 0.5 * (predicted(0, 0) + predicted(1, 1));
  const double excess_rad2 = std::max(0.0, tilt_rad2 - known_rad2);
  const double gain = std::min(1.0, dt_s / config_.scan_noise_time_s);
  excess_rad2_ += gain * (excess_rad2 - excess_rad2_);
  newest_excess_rad2_ = excess_rad2;
  const bool outlier = tilt_rad2 > squared(kOutlierSigmas) * (known_rad2 + squared(config_.scan_sigma_rad));
  outlier_share_ += std::min(1.0, dt_s / kOutlierTimeS) * ((outlier ? 1.0 : 0.0) - outlier_share_);
}

Eigen::Matrix3d MountFilter::noise(double dt_s, const Eigen::Vector3d& turn_rad) const {
  const double variance =
      std::max({squared(config_.scan_sigma_rad), excess_rad2_, kNewestShare * newest_excess_rad2_});
  const Eigen::Vector3d late_rad = q_mount_.conjugate() * (turn_rad * (config_.clock_sigma_s / dt_s));
  // Correlated noise of variance s^2 and correlation time c has the density of white noise 2 c s^2.
  const double white = std::max(1.0, 2.0 * config_.scan_correlation_s / dt_s);
  return white * (variance * Eigen::Matrix3d::Identity() + late_rad * late_rad.transpose());
}

// up(surfaces) = exp(-e) up(gravity): first order up(gravity) x e beyond the estimate.
void MountFilter::add_level(const LevelEvidence& level) {
  const Eigen::Vector3d expected = q_mount_.conjugate() * level.up_by_gravity;
  Eigen::Matrix<double, 3, 6> H = Eigen::Matrix<double, 3, 6>::Zero();
  H.leftCols<3>() = q_mount_.toRotationMatrix().transpose() * skew(level.up_by_gravity);
  const Eigen::Matrix3d S = H * P_ * H.transpose() + level.covariance_rad2;
  const Eigen::Matrix<double, 6, 3> K = P_ * H.transpose() * S.inverse();
  apply(K * (level.up_by_surfaces - expected));
  P_ -= (K * H * P_).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

void MountFilter::apply(const Vector6& error) {
  q_mount_ = (exp_so3(error.head<3>()) * q_mount_).normalized();
  q_map_base_ = (exp_so3(error.tail<3>()) * q_map_base_).normalized();
}

bool MountFilter::consistent() const { return outlier_share_ < kInconsistentShare; }

Eigen::Vector3d MountFilter::mount_error_rad() const { return log_so3(q_mount_); }

}  // namespace isobar
