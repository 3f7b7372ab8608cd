// SPDX-License-Identifier: BSD-3-Clause
// A configured mount with the error that was found in it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"

namespace isobar {

/// Rotation of the true mount in base_link: exp(error^) R(configured). `error_rad`: MountEstimate::error_rad.
inline Eigen::Matrix3d corrected_rotation(const Eigen::Vector3d& configured_rpy_deg,
                                          const Eigen::Vector3d& error_rad) {
  return exp_so3(error_rad).toRotationMatrix() * rotation_from_rpy_deg(configured_rpy_deg);
}

/// The same as roll, pitch, yaw about fixed axes [deg], for rpy_deg of the configuration; pitch is -90 … 90. At +-90,
/// where only roll minus yaw is defined, roll is 0.
inline Eigen::Vector3d corrected_rpy_deg(const Eigen::Vector3d& configured_rpy_deg,
                                         const Eigen::Vector3d& error_rad) {
  // R = Rz(yaw) Ry(pitch) Rx(roll): R20 = -sin(pitch), R21 = cos(pitch) sin(roll), R10 = sin(yaw) cos(pitch).
  const Eigen::Matrix3d R = corrected_rotation(configured_rpy_deg, error_rad);
  constexpr double kLeastCosine = 1e-6;
  const double pitch = -std::asin(std::clamp(R(2, 0), -1.0, 1.0));
  if (std::hypot(R(0, 0), R(1, 0)) < kLeastCosine) {
    return Eigen::Vector3d(0.0, pitch, std::atan2(-R(0, 1), R(1, 1))) / kRadPerDeg;
  }
  return Eigen::Vector3d(std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))) / kRadPerDeg;
}

}  // namespace isobar
