// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/submap.hpp"

#include <cmath>

namespace isobar {

Eigen::Isometry3d upright(const Eigen::Isometry3d& T_map_base) {
  const Eigen::Vector3d forward = T_map_base.linear().col(0);
  Eigen::Isometry3d T_map_upright = Eigen::Isometry3d::Identity();
  T_map_upright.linear() =
      Eigen::AngleAxisd(std::atan2(forward.y(), forward.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_map_upright.translation() = T_map_base.translation();
  return T_map_upright;
}

}  // namespace isobar
