// SPDX-License-Identifier: BSD-3-Clause
// Mount of the lidar, found while driving: roll and pitch against the IMU from turns, yaw from straight drives
// against the wheels (or from turns that tilt), scale of the wheels.
//
//     registered scan ─┬─▶ MountFilter ─────────▶ roll, pitch, yaw against the IMU
//     priors (gyro) ───┤       │ smoothed attitude
//     priors (wheels) ─┴─▶ WheelComparison ─────▶ yaw against the wheels; scale of distance and turn
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/mounts/mount_evidence.hpp"
#include "core/mounts/mount_filter.hpp"
#include "core/mounts/wheel_comparison.hpp"
#include "core/prior/prior_history.hpp"

namespace isobar {

/// How far a MountEstimate can be used.
enum class MountVerdict : std::uint8_t {
  kUnknown,       ///< roll or pitch is not observed yet: no turns, no level surfaces
  kFound,         ///< sigma of roll and pitch is below 0.4 deg, and scans and gyro agree
  kInconsistent,  ///< scans and gyro contradict each other: lost registration, moving ground; do not use
};

/// A factor and its standard deviation; 1 and infinite where nothing was measured.
struct ScaleEstimate {
  double scale = 1.0;
  double sigma = 0.0;
};

/// Result: R_base_lidar(true) = exp(error^) R_base_lidar(configured).
struct MountEstimate {
  MountVerdict verdict = MountVerdict::kUnknown;
  Eigen::Vector3d error_rad =
      Eigen::Vector3d::Zero();  ///< rotation vector, axes of base_link: roll, pitch, yaw
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();  ///< of error_rad, systematic errors included
  bool yaw_found = false;        ///< sigma of yaw is below 0.4 deg, with wheels below 0.2 deg
  double outlier_share = 0.0;    ///< scans that contradict the gyro, 0 … 1
  ScaleEstimate wheel_distance;  ///< true distance = scale x the wheels'
  ScaleEstimate wheel_turn;      ///< true turn = scale x the wheels': nominal over effective track width

  /// Standard deviation of each component of error_rad.
  [[nodiscard]] Eigen::Vector3d sigma_rad() const { return covariance_rad2.diagonal().cwiseSqrt(); }
};

/// Takes registered scans in order of time. Allocates nothing. Not thread-safe.
class MountEstimator {
 public:
  /// `q_base_lidar`: configured rotation of the lidar in base_link, to which the estimate refers.
  explicit MountEstimator(const Eigen::Quaterniond& q_base_lidar, const MountFilterConfig& config = {});

  /// A registered scan. `history`: priors that reach from the scan before to this one.
  void add(const ScanMotionEvidence& scan, const PriorHistory& history);

  /// Level surfaces around a robot at rest (level_surfaces.hpp). The first ones count: gravity has the same error,
  /// that of the accelerometer, at every halt.
  void add_level(const LevelEvidence& level);

  [[nodiscard]] MountEstimate estimate() const;

 private:
  [[nodiscard]] Eigen::Quaterniond configured_attitude(const ScanMotionEvidence& scan) const;
  [[nodiscard]] bool follows(const ScanMotionEvidence& scan) const;
  void begin(const ScanMotionEvidence& scan);
  void compare_wheels(const ScanMotionEvidence& scan, const Prior& prior, double gyro_turn_z_rad);
  void use_wheels_yaw(MountEstimate& out) const;

  Eigen::Quaterniond q_base_lidar_;
  MountFilter filter_;
  WheelComparison wheels_;
  bool level_used_ = false;
  bool started_ = false;
  bool has_wheels_ = false;
  ScanMotionEvidence last_;
};

}  // namespace isobar
