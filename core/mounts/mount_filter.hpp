// SPDX-License-Identifier: BSD-3-Clause
// Rotation of the lidar against the IMU, from the attitudes of registered scans and the turns of the gyro: an
// error-state Kalman filter, O(1) a scan.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mounts/mount_evidence.hpp"

namespace isobar {

/// Errors of gyro and scans that the filter reckons with.
struct MountFilterConfig {
  /// Error of the configured mount per axis before any evidence, 1 sigma [rad]: 1 deg. Hands build to 0.5.
  double mount_sigma_rad = 0.0175;
  /// Noise of the attitude of one scan, 1 sigma [rad] (0.07 deg), and its correlation time [s]: neighbouring scans
  /// meet the same errors of the map.
  double scan_sigma_rad = 0.0012;
  double scan_correlation_s = 0.5;
  /// Time over which a larger noise of the scans is measured [s].
  double scan_noise_time_s = 2.0;
  /// Gyro: angle random walk with the error of its bias [rad/sqrt(s)], and error of its scale as random walk with
  /// the turn, along the axis of the turn [rad/sqrt(rad)].
  double gyro_walk_rad_sqrt_s = 3.5e-4;
  double gyro_scale_walk = 0.005;
  /// Tilt of the map: random walk with the way into the unknown [rad/sqrt(m)]: 0.1 deg after a metre.
  double map_tilt_walk_rad_sqrt_m = 1.8e-3;
  /// Offset between the clocks of lidar and IMU, 1 sigma [s]: an error along the axis of the turn.
  double clock_sigma_s = 0.005;
};

/// State: e, rotation vector of the mount's error in axes of base_link, and the attitude of base_link in the map.
///
///     R_base_lidar(true) = exp(e^) R_base_lidar(configured)
///     R_map_base(scan, by the configured mount) = R_map_base exp(e^)
///
/// The attitude is predicted by the gyro, and each scan measures the product. While the robot keeps its attitude,
/// e and an error m of the attitude (axes of the map) are one: the measurement is e + R^T m. A turn separates
/// them about the axes across it: phi(scan) - phi(gyro) = phi x e.
class MountFilter {
 public:
  explicit MountFilter(const MountFilterConfig& config);

  /// Takes the attitude in the map as unknown: a first scan, a gap, another map. Keeps the mount.
  void restart(const Eigen::Quaterniond& q_map_base_scan);
  [[nodiscard]] bool started() const { return started_; }

  /// A scan, `dt_s` (> 0) after the one before; `turn`: rotation base(before) <- base(now) by the gyro; `way_m`: its
  /// length; `q_map_base_scan`: attitude by the scan with the configured mount.
  void add(double dt_s, const Eigen::Quaterniond& turn, double way_m,
           const Eigen::Quaterniond& q_map_base_scan);

  /// Level surfaces around the robot at rest.
  void add_level(const LevelEvidence& level);

  /// e [rad] and its covariance, which holds no systematic errors.
  [[nodiscard]] Eigen::Vector3d mount_error_rad() const;
  [[nodiscard]] Eigen::Matrix3d covariance_rad2() const { return P_.topLeftCorner<3, 3>(); }
  /// Attitude in the map by the configured mount, smoothed.
  [[nodiscard]] Eigen::Quaterniond q_map_base_configured() const { return q_map_base_ * q_mount_; }
  /// Mean share of scans whose roll and pitch lie outside of three standard deviations, 0 … 1, over half a minute.
  [[nodiscard]] double outlier_share() const { return outlier_share_; }
  /// False while scans and gyro contradict each other: the mount is held.
  [[nodiscard]] bool consistent() const;

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  void predict(double dt_s, const Eigen::Vector3d& turn_rad, double way_m);
  void watch(double dt_s, const Eigen::Vector3d& residual, const Eigen::Matrix3d& predicted);
  [[nodiscard]] Eigen::Matrix3d noise(double dt_s, const Eigen::Vector3d& turn_rad) const;
  void apply(const Vector6& error);

  MountFilterConfig config_;
  bool started_ = false;
  Eigen::Quaterniond q_mount_ = Eigen::Quaterniond::Identity();  // exp(e)
  Eigen::Quaterniond q_map_base_ = Eigen::Quaterniond::Identity();
  Matrix6 P_ = Matrix6::Zero();  // of (e, m)
  double excess_rad2_ = 0.0;  // variance of roll and of pitch beyond the predicted one, in the last seconds
  double newest_excess_rad2_ = 0.0;
  double outlier_share_ = 0.0;
};

}  // namespace isobar
