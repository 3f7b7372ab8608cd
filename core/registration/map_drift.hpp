// SPDX-License-Identifier: BSD-3-Clause
// Error of the map in x, y and yaw where the robot is: it grows with the way, because every scan of new ground is laid
// onto the one before.
//
//     psi <- psi + walk,   (x, y) <- (x, y) + psi e_z x step + walk      random walks with the way
#pragma once

#include <Eigen/Core>

#include "core/squared.hpp"

namespace isobar {

/// Covariance of (x, y, yaw) of the map frame at the robot against the world, exact at the start.
class MapDrift {
 public:
  void restart() { P_.setZero(); }

  /// The robot has moved by `step_m`, axes of the map.
  void move(const Eigen::Vector2d& step_m) {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 2) = -step_m.y();
    F(1, 2) = step_m.x();
    P_ = (F * P_ * F.transpose()).eval();
    const double way_m = step_m.norm();
    P_.diagonal().head<2>().array() += squared(kPositionWalkMSqrtM) * way_m;
    P_(2, 2) += squared(kYawWalkRadSqrtM) * way_m;
  }

  /// Of (x, y, yaw) [m^2, m rad, rad^2].
  [[nodiscard]] const Eigen::Matrix3d& covariance() const { return P_; }

 private:
  // Measured on the simulated buildings: 0.25 deg and 5 cm on the first 100 m.
  static constexpr double kYawWalkRadSqrtM = 5e-4;
  static constexpr double kPositionWalkMSqrtM = 5e-3;

  Eigen::Matrix3d P_ = Eigen::Matrix3d::Zero();
};

}  // namespace isobar
