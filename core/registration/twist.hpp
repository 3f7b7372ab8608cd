// SPDX-License-Identifier: BSD-3-Clause
// Twists of the solver: (omega_x, omega_y, omega_z, r_x, r_y, r_z), axes of the map, rotation about the
// robot's position, translation of that position.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/estimates.hpp"
#include "core/so3.hpp"

namespace isobar {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Pose moved by a twist: R' = exp(omega) R, p' = p + r (the retraction of the Gauss-Newton step).
inline Eigen::Isometry3d moved_by(const Vector6d& twist, const Eigen::Isometry3d& T_map_base) {
  Eigen::Isometry3d moved = T_map_base;
  const Eigen::Quaterniond turn = exp_so3(twist.head<3>());
  moved.linear() = (turn * Eigen::Quaterniond(T_map_base.linear())).normalized().toRotationMatrix();
  moved.translation() += twist.tail<3>();
  return moved;
}

/// Twist that leads from `from` to `to`; the inverse of moved_by().
inline Vector6d twist_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Vector6d twist;
  twist << log_so3(Eigen::Quaterniond(to.linear() * from.linear().transpose())),
      to.translation() - from.translation();
  return twist;
}

/// Covariance of a twist in the order (x, y, z, roll, pitch, yaw) of PoseEstimate::covariance. For small tilt
/// the rotation vector's components are the errors of the angles.
inline Matrix6d as_pose_covariance(const Matrix6d& twist_covariance) {
  Matrix6d covariance;
  covariance << twist_covariance.bottomRightCorner<3, 3>(), twist_covariance.bottomLeftCorner<3, 3>(),
      twist_covariance.topRightCorner<3, 3>(), twist_covariance.topLeftCorner<3, 3>();
  return covariance;
}

}  // namespace isobar
