// SPDX-License-Identifier: BSD-3-Clause
// Error of a pose that is the sum of its steps: random part and part that constants make.
//
//     theta <- theta + walk,   p <- p + theta x step + walk
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/estimates.hpp"
#include "core/so3.hpp"

namespace isobar {

/// Covariance of (x, y, z, roll, pitch, yaw), axes of the map, errors as PoseEstimate::covariance has them.
struct GrowingError {
  static constexpr int kConstants = 3;
  using Constants = Eigen::Matrix<double, 6, kConstants>;

  Matrix6d random = Matrix6d::Zero();
  /// What constants of variance 1 (a scale, a bias, an offset) have done to the pose: they grow with the way, not with
  /// its root.
  Constants constants = Constants::Zero();

  /// The robot has moved by `step_m`, axes of the map.
  void move(const Eigen::Vector3d& step_m) {
    const Eigen::Matrix3d turned = skew(step_m).transpose();  // theta -> theta x step
    random.topRows<3>() += turned * random.bottomRows<3>();
    random.leftCols<3>() += random.rightCols<3>() * turned.transpose();
    constants.topRows<3>() += turned * constants.bottomRows<3>();
  }

  [[nodiscard]] Matrix6d covariance() const { return random + constants * constants.transpose(); }
};

}  // namespace isobar
