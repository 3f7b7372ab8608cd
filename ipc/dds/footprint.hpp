// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "core/so3.hpp"

namespace isobar::dds {

/// Pose of the point on the ground vertically under base_link, with its yaw only: x and y are those of base_link. The
/// ground is the plane on which the robot stands, `depth_m` under base_link along its own z.
/// @param T_odom_base in a frame whose z is vertical
[[nodiscard]] inline Eigen::Isometry3d footprint_of(const Eigen::Isometry3d& T_odom_base, double depth_m) {
  constexpr double kSteepest = 0.5;  // cosine: a robot on its side has no ground under it
  const Eigen::Matrix3d R = T_odom_base.linear();
  Eigen::Isometry3d T_odom_footprint = Eigen::Isometry3d::Identity();
  T_odom_footprint.linear() = rotation_about_z(yaw_of(R));
  T_odom_footprint.translation() = T_odom_base.translation();
  T_odom_footprint.translation().z() -= depth_m / std::max(R(2, 2), kSteepest);
  return T_odom_footprint;
}

}  // namespace isobar::dds
