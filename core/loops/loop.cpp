// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/loop.hpp"

#include "core/so3.hpp"

namespace isobar {

// p_holder = p_base + (p_holder - p_base): a rotation w of the base about its own position moves the holder's origin by
// w x lever.
Matrix6d Loop::holder_covariance() const {
  const Eigen::Vector3d lever = T_submap_holder().translation() - T_submap_base.translation();
  Matrix6d J = Matrix6d::Identity();
  J.topRightCorner<3, 3>() = -skew(lever);
  return J * covariance * J.transpose();
}

}  // namespace isobar
