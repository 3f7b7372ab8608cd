// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "core/estimates.hpp"
#include "core/so3.hpp"

namespace isobar {

/// The level frame of a pose: its origin and heading.
[[nodiscard]] inline Eigen::Isometry3d levelled(const Eigen::Isometry3d& T) {
  Eigen::Isometry3d level = T;
  level.linear() = rotation_about_z(yaw_of(T.linear()));
  return level;
}

/// Pose of base_link in the frame of dead reckoning.
[[nodiscard]] inline Eigen::Isometry3d odometry_of(const PoseEstimate& pose) {
  return pose.T_map_odom.inverse(Eigen::Isometry) * pose.T_map_base;
}

}  // namespace isobar
