// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "core/estimates.hpp"

namespace isobar {

/// Pose of base_link in the frame of dead reckoning.
[[nodiscard]] inline Eigen::Isometry3d odometry_of(const PoseEstimate& pose) {
  return pose.T_map_odom.inverse(Eigen::Isometry) * pose.T_map_base;
}

}  // namespace isobar
