// SPDX-License-Identifier: BSD-3-Clause
// Prior of the pose graph: a pose of a submap in the map that is known from elsewhere, as in a stored map's frame.
//
//     e = ( p - t,  log(R_s R^T) ),   (R, t) = known T_map_submap,   de/d(d, w) = ( I, 0;  0, J )
//
// J: inverse left Jacobian at the error.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/estimates.hpp"
#include "core/graph/graph_node.hpp"
#include "core/graph/relative_pose_edge.hpp"
#include "core/graph/rotation_error.hpp"

namespace isobar {

/// Known pose of a node.
struct PosePrior {
  NodeId node = 0;
  Eigen::Isometry3d T_map_submap = Eigen::Isometry3d::Identity();
  /// Of x, y, z [m] and the rotation vector (roll, pitch, yaw) [rad], about the axes of the map. Of a node held by gravity
  /// only x, y, z and yaw are used.
  Matrix6d covariance = Matrix6d::Identity();
};

/// Error e of a pose against a known one.
inline Vector6d prior_error(const Eigen::Isometry3d& T_map_submap, const Eigen::Isometry3d& T_known) {
  Vector6d error;
  error << T_map_submap.translation() - T_known.translation(),
      rotation_error(T_map_submap.linear(), T_known.linear());
  return error;
}

/// Jacobian of the error by the node's step.
inline NodeJacobian<6> prior_jacobian(const Vector6d& error) {
  NodeJacobian<6> J = NodeJacobian<6>::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.block<3, 3>(3, 3) = inverse_left_jacobian(error.tail<3>());
  return J;
}

}  // namespace isobar
