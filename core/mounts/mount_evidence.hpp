// SPDX-License-Identifier: BSD-3-Clause
// What a registered scan says about the mount of the lidar.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

namespace isobar {

/// Pose of a registered scan. Scans that were not registered are left out.
struct ScanMotionEvidence {
  std::int64_t stamp_ns = 0;  ///< end of the scan
  std::uint32_t session = 1;  ///< number of the map frame; no motion is measured across two frames

  /// Pose of base_link by the scan, with the mount `q_base_lidar`. The scan must have estimated roll and pitch:
  /// an attitude that a method fixes to gravity says nothing about the mount.
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  /// Rotation of the lidar in base_link that the registration of this scan used.
  Eigen::Quaterniond q_base_lidar = Eigen::Quaterniond::Identity();

  /// Turn about z of base_link by the wheels since the evidence before [rad]; NaN where unknown.
  double wheel_turn_rad = std::numeric_limits<double>::quiet_NaN();
};

/// Level surfaces around a robot at rest: up directions in base axes by the configured mount, unit vectors.
struct LevelEvidence {
  Eigen::Vector3d up_by_gravity = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up_by_surfaces = Eigen::Vector3d::UnitZ();
  /// Of the difference, in base axes, with the error of gravity [rad^2].
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();
  /// Of the up direction by the surfaces alone, in base axes [rad^2].
  Eigen::Matrix3d surfaces_covariance_rad2 = Eigen::Matrix3d::Zero();
};

}  // namespace isobar
