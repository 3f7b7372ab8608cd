// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/submap.hpp"

#include "core/so3.hpp"

namespace isobar {

Eigen::Isometry3d upright(const Eigen::Isometry3d& T_map_base) {
  Eigen::Isometry3d T_map_upright = Eigen::Isometry3d::Identity();
  T_map_upright.linear() = rotation_about_z(yaw_of(T_map_base.linear()));
  T_map_upright.translation() = T_map_base.translation();
  return T_map_upright;
}

}  // namespace isobar
