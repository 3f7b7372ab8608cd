// SPDX-License-Identifier: BSD-3-Clause
// Roll and pitch of the lidar from the surfaces around a robot at rest: walls of buildings are plumb, floors and
// ceilings level. Tells the mount within a second, before the first turn; on slopes and outdoors it tells nothing.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/mounts/mount_evidence.hpp"
#include "core/mounts/wall_patches.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Collects the scans of a halt. Allocates in its constructor only. Not thread-safe.
///
/// Unknown: the tilt (a, b) of the surfaces against gravity, in a frame whose z axis is gravity's. The up direction
/// by the surfaces is (a, b, 1). A wall of normal n says n . (a, b, 1) = 0, one component of the tilt; a floor
/// z = c - a x - b y says both.
class LevelSurfaces {
 public:
  /// @param p_base_lidar_m position of the lidar
  explicit LevelSurfaces(const Eigen::Vector3d& p_base_lidar_m = Eigen::Vector3d::Zero());

  /// Begins a new halt.
  void clear() { p_base_.clear(); }
  /// Points of a deskewed scan by the configured mount. Ten scans, a second, average the noise; points beyond the
  /// capacity of 30 000 points are ignored.
  void add(std::span<const ScanPoint> p_base);
  [[nodiscard]] bool full() const { return p_base_.size() == p_base_.capacity(); }

  /// The evidence of all scans since clear(). Takes 5 to 20 ms: call it once a halt. `up_by_gravity`: unit vector in base axes;
  /// `gravity_variance_rad2`: of roll and of pitch (Prior::roll_pitch_variance_rad2). The error that the
  /// accelerometer's bias makes is added here. None where walls, floor and ceiling do not agree, or are missing.
  std::optional<LevelEvidence> find(const Eigen::Vector3d& up_by_gravity, double gravity_variance_rad2);

 private:
  void tell_rings_by_elevation();

  Eigen::Vector3f p_base_lidar_m_;
  std::vector<LevelPoint> p_base_;
  std::vector<LevelPoint> p_level_;  // z axis along gravity
  WallPatches walls_;
};

}  // namespace isobar
