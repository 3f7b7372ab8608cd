// SPDX-License-Identifier: BSD-3-Clause
// Floors and ceilings: large planes that are nearly level.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/mounts/tilt_evidence.hpp"

namespace isobar {

/// z = slope x + height: (slope_x, slope_y, height) . (x, y, 1).
struct LevelPlane {
  Eigen::Vector3d slope_and_height_m = Eigen::Vector3d::Zero();
  TiltEvidence tilt;  ///< if the plane is level; its covariance holds the noise of the points
  int points = 0;     ///< on the plane

  [[nodiscard]] double distance_m(const Eigen::Vector3f& p_level) const {
    return p_level.z() - slope_and_height_m.dot(Eigen::Vector3d(p_level.x(), p_level.y(), 1.0));
  }
};
/// Least number of lasers with a share of a plane's points: one laser on walls around the robot draws a level line as well.
inline constexpr int kLeastLevelRings = 4;

using LevelPlanes = std::array<std::optional<LevelPlane>, 2>;

/// Two planes at least a metre apart, usually floor and ceiling, the one with more points first.
/// `p_level`: points in a frame whose z axis is gravity's [m].
LevelPlanes level_planes(std::span<const LevelPoint> p_level);
/// Removes the points on these planes: in a cell with a wall they are no part of it.
void remove_planes(const LevelPlanes& planes, std::vector<LevelPoint>& p_level);

}  // namespace isobar
