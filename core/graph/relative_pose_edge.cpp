// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/relative_pose_edge.hpp"

#include "core/graph/rotation_error.hpp"

namespace isobar {

Vector6d relative_pose_error(const Eigen::Isometry3d& T_map_from, const Eigen::Isometry3d& T_map_to,
                             const Eigen::Isometry3d& T_from_to) {
  const Eigen::Matrix3d R_from_map = T_map_from.linear().transpose();
  Vector6d error;
  error << R_from_map * (T_map_to.translation() - T_map_from.translation()) - T_from_to.translation(),
      rotation_error(R_from_map * T_map_to.linear(), T_from_to.linear());
  return error;
}

RelativePoseError linearised_relative_pose(const Eigen::Isometry3d& T_map_from,
                                           const Eigen::Isometry3d& T_map_to,
                                           const Eigen::Isometry3d& T_from_to) {
  const Eigen::Matrix3d R_from_map = T_map_from.linear().transpose();
  RelativePoseError out{relative_pose_error(T_map_from, T_map_to, T_from_to), NodeJacobian<6>::Zero(),
                        NodeJacobian<6>::Zero()};
  const Eigen::Matrix3d by_turn = inverse_left_jacobian(out.error.tail<3>()) * R_from_map;
  out.by_to.topLeftCorner<3, 3>() = R_from_map;
  out.by_to.block<3, 3>(3, 3) = by_turn;
  out.by_from.topLeftCorner<3, 3>() = -R_from_map;
  out.by_from.block<3, 3>(0, 3) = R_from_map * skew(T_map_to.translation() - T_map_from.translation());
  out.by_from.block<3, 3>(3, 3) = -by_turn;
  return out;
}

}  // namespace isobar
