// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "core/estimates.hpp"

namespace isobar {

/// Place of a submap in the one before it.
struct ChainLink {
  Eigen::Isometry3d T_before_submap = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< x, y, z [m], roll, pitch, yaw [rad], axes of the submap before
};

}  // namespace isobar
