// SPDX-License-Identifier: BSD-3-Clause
// Edge of the pose graph: a measured pose of one submap in another one, from odometry or from a loop.
//
//     e = ( R_f^T (p_t - p_f) - t,  log(R_f^T R_t R^T) ),   (R, t) = measured T_from_to
//
//     de/d(d_t, w_t) = ( R_f^T, 0;                       0,  J R_f^T )       J: inverse left Jacobian at the error
//     de/d(d_f, w_f) = (-R_f^T, R_f^T [p_t - p_f];       0, -J R_f^T )
//
// Source: Grisetti, Kuemmerle, Stachniss, Burgard, "A tutorial on graph-based SLAM", 2010, section IV, with the steps of
// graph_node.hpp.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/estimates.hpp"
#include "core/graph/graph_node.hpp"

namespace isobar {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Origin of a relative pose.
enum class EdgeKind {
  kOdometry,  ///< from one submap to the next: taken as it is
  kLoop,      ///< from recognising a place: may be wrong, and is then left out
};

/// Measured relative pose of two nodes.
struct RelativePoseEdge {
  NodeId from = 0;
  NodeId to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  /// Of the error e: x, y, z [m], then the rotation vector (roll, pitch, yaw) [rad], all about the axes of `from`. Between
  /// two nodes held by gravity only the rows and columns of x, y, z and yaw are used, the others may be zero.
  Matrix6d covariance = Matrix6d::Identity();
  EdgeKind kind = EdgeKind::kOdometry;
};

/// Error of a relative pose and its Jacobians by the steps of both nodes.
struct RelativePoseError {
  Vector6d error;
  NodeJacobian<6> by_from;
  NodeJacobian<6> by_to;
};

/// Error e of two poses against a measured `T_from_to`.
Vector6d relative_pose_error(const Eigen::Isometry3d& T_map_from, const Eigen::Isometry3d& T_map_to,
                             const Eigen::Isometry3d& T_from_to);

/// The same with its Jacobians.
RelativePoseError linearised_relative_pose(const Eigen::Isometry3d& T_map_from,
                                           const Eigen::Isometry3d& T_map_to,
                                           const Eigen::Isometry3d& T_from_to);

}  // namespace isobar
