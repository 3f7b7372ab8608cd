// SPDX-License-Identifier: BSD-3-Clause
// Angles in degrees, and mounts of sensors.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/so3.hpp"

namespace isobar {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadPerDeg = kPi / 180.0;

/// Rotation of a sensor in base_link from roll, pitch, yaw in degrees about the fixed axes x, y, z of
/// base_link, as the recording format and URDF define it: p_base = R p_sensor.
inline Eigen::Matrix3d rotation_from_rpy_deg(const Eigen::Vector3d& rpy_deg) {
  return rotation_from_rpy(rpy_deg * kRadPerDeg).toRotationMatrix();
}

/// Mounting position and rotation of a sensor on the robot.
struct Mount {
  Eigen::Vector3d xyz_m = Eigen::Vector3d::Zero();  ///< origin of the sensor in base_link
  Eigen::Vector3d rpy_deg =
      Eigen::Vector3d::Zero();  ///< fixed-axis roll, pitch, yaw of the sensor in base_link

  /// Pose of the sensor in base_link: takes a point of the sensor's frame to base_link.
  [[nodiscard]] Eigen::Isometry3d T_base_sensor() const {  // NOLINT(readability-identifier-naming)
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation_from_rpy_deg(rpy_deg);
    T.translation() = xyz_m;
    return T;
  }
};

}  // namespace isobar
