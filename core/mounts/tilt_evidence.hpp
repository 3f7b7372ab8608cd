// SPDX-License-Identifier: BSD-3-Clause
// Points around a robot at rest, and the tilt (a, b) of surfaces against gravity [rad]: the up direction by the surfaces is (a, b, 1).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// A point in a frame whose z axis is gravity's, or in base_link [m].
struct LevelPoint {
  Eigen::Vector3f p_m;
  std::uint8_t ring;  ///< laser
};

/// A measurement of the tilt. A direction without information has a large variance.
struct TiltEvidence {
  Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();
};

}  // namespace isobar
