// SPDX-License-Identifier: BSD-3-Clause
// Rotations: the exponential and logarithm map of SO(3), the only ones in the tree, and related conversions.
//
// Source: Sola, "Quaternion kinematics for the error-state Kalman filter", 2017, sections 2.4 and 4.4.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace isobar {

/// Below this the maps use their first-order series [rad]: the next term is smaller by its square, 1e-18.
inline constexpr double kSmallAngleRad = 1e-9;

/// Exponential map: rotation by |angle_rad| about angle_rad, as a unit quaternion.
/// q = (cos(a / 2), sin(a / 2) u) with a = |angle_rad|, u = angle_rad / a; first order: (1, angle_rad / 2).
inline Eigen::Quaterniond exp_so3(const Eigen::Vector3d& angle_rad) {
  const double angle = angle_rad.norm();
  if (angle < kSmallAngleRad) {
    return Eigen::Quaterniond(1.0, 0.5 * angle_rad.x(), 0.5 * angle_rad.y(), 0.5 * angle_rad.z())
        .normalized();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angle_rad / angle));
}

/// Angle of a rotation [rad], 0 … pi. `q` is a unit quaternion.
inline double rotation_angle_rad(const Eigen::Quaterniond& q) {
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

/// Logarithm map, the inverse of exp_so3(): rotation vector [rad] of length 0 … pi of a unit quaternion.
/// q and -q are the same rotation.
inline Eigen::Vector3d log_so3(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (sine < kSmallAngleRad) return 2.0 * sign * q.vec();
  return rotation_angle_rad(q) * (q.vec() / (sign * sine));
}

/// Matrix of the cross product: skew(a) b = a x b.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

/// Yaw of a rotation [rad], -pi … pi, z-y-x convention.
inline double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

/// Yaw of a rotation matrix [rad], -pi … pi, z-y-x convention: heading of its x axis.
inline double yaw_of(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

/// Rotation about z by `yaw_rad`, as a matrix.
inline Eigen::Matrix3d rotation_about_z(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// Rotation about z that is nearest to `rotation` in the Frobenius norm: it maximises the trace of
/// result^T rotation.
inline Eigen::Matrix3d nearest_rotation_about_z(const Eigen::Matrix3d& rotation) {
  return rotation_about_z(std::atan2(rotation(1, 0) - rotation(0, 1), rotation(0, 0) + rotation(1, 1)));
}

/// Rotation by roll, pitch, yaw [rad] about the fixed axes x, y, z: R = Rz(yaw) Ry(pitch) Rx(roll).
inline Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& rpy_rad) {
  return Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
}

}  // namespace isobar
