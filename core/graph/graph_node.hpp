// SPDX-License-Identifier: BSD-3-Clause
// Node of the pose graph: the pose of a submap, and what of it may move.
//
// A pose moves by a step in the axes of the map, its rotation about its own origin:
//
//     p <- p + d,   R <- exp(w) R,   step = (d, w)
//
// Position and rotation are separate, so that a step has no lever to the origin of the map. A node that gravity holds
// moves by d and w_z alone: the same Jacobians serve both kinds, with two columns less.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/so3.hpp"

namespace isobar {

/// Number of a node, in the order of addition, from 0.
using NodeId = int;

/// Submap in the map.
struct GraphNode {
  Eigen::Isometry3d T_map_submap = Eigen::Isometry3d::Identity();
  bool held_by_gravity = true;  ///< roll and pitch are known from gravity: 4-DOF, else 6-DOF
  std::int64_t stamp_ns = 0;    ///< of the submap's frame; orders the altimeter's bias in time
};

/// Step of a node: x, y, z [m], rotation vector [rad] (all in axes of the map), bias of the altimeter [m].
using NodeStep = Eigen::Matrix<double, 7, 1>;
inline constexpr int kBiasColumn = 6;

/// Jacobian of `Rows` errors by a node's step.
template <int Rows>
using NodeJacobian = Eigen::Matrix<double, Rows, 7, Rows == 1 ? Eigen::RowMajor : Eigen::ColMajor>;

/// Unknowns of a graph at their present estimates.
struct GraphState {
  std::vector<GraphNode> nodes;
  std::vector<double> bias_m;  ///< altimeter minus height at each node; zero where there is no altitude
};

/// Pose after a step.
inline Eigen::Isometry3d moved(const Eigen::Isometry3d& T_map_submap, const NodeStep& step) {
  Eigen::Isometry3d T = T_map_submap;
  T.translation() += step.head<3>();
  const Eigen::Quaterniond q = exp_so3(step.segment<3>(3)) * Eigen::Quaterniond(T_map_submap.linear());
  T.linear() = q.normalized().toRotationMatrix();
  return T;
}

}  // namespace isobar
