// SPDX-License-Identifier: BSD-3-Clause
// Small rotations, used by every filter of the prior.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace isobar {

/// Rotation by the angle |angle_rad| about angle_rad (exponential map).
inline Eigen::Quaterniond rotation_of(const Eigen::Vector3d& angle_rad) {
  const double angle = angle_rad.norm();
  if (angle < 1e-9) {
    return Eigen::Quaterniond(1.0, 0.5 * angle_rad.x(), 0.5 * angle_rad.y(), 0.5 * angle_rad.z())
        .normalized();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angle_rad / angle));
}

/// Inverse of rotation_of(), in the half turn around zero (logarithm map).
inline Eigen::Vector3d angle_of(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2.0 * sign * q.vec();
  return 2.0 * std::atan2(sine, sign * q.w()) * sign / sine * q.vec();
}

/// Matrix of the cross product: skew(a) b = a x b.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// Yaw of a rotation, z-y-x convention [rad].
inline double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

}  // namespace isobar
