// SPDX-License-Identifier: BSD-3-Clause
// Rotation vector between two attitudes, and its Jacobian.
//
// Source: Sola, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", 2018, equation (146).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/so3.hpp"

namespace isobar {

/// Below this the inverse left Jacobian uses its series [rad]: the next term is a^4 / 720, 1e-19.
inline constexpr double kSeriesAngleRad = 1e-4;

/// Rotation vector w [rad] with R = exp(w) R_reference.
inline Eigen::Vector3d rotation_error(const Eigen::Matrix3d& R, const Eigen::Matrix3d& R_reference) {
  return log_so3(Eigen::Quaterniond(R * R_reference.transpose()).normalized());
}

/// Inverse left Jacobian of SO(3): log(exp(d) exp(w)) = w + J d to first order,
///
///     J = I - [w]/2 + (1/a^2 - (1 + cos a) / (2 a sin a)) [w]^2,   a = |w|
inline Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& w) {
  const double a = w.norm();
  const double square =
      a < kSeriesAngleRad ? 1.0 / 12.0 : 1.0 / (a * a) - (1.0 + std::cos(a)) / (2.0 * a * std::sin(a));
  const Eigen::Matrix3d W = skew(w);
  return Eigen::Matrix3d::Identity() - 0.5 * W + square * W * W;
}

}  // namespace isobar
