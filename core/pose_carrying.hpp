// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning: one step from a twist, and propagation of a known pose by the steps since.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/so3.hpp"

namespace isobar {

/// Displacement in the world [m] of a body that moves by `step_base_m` (its own axes) while it turns at a
/// constant rate. Midpoint rule: the step is rotated by the attitude half-way, error of third order in time.
///
/// `q_world_base`: attitude at the start or at the end of the step. `half_turn_rad`: rotation vector (base
/// axes) from there to the middle: half of the turn from the start, minus half of it from the end.
inline Eigen::Vector3d midpoint_step(const Eigen::Quaterniond& q_world_base,
                                     const Eigen::Vector3d& half_turn_rad,
                                     const Eigen::Vector3d& step_base_m) {
  return q_world_base * exp_so3(half_turn_rad) * step_base_m;
}

/// Propagation of a pose in the map by dead reckoning since a time (then) at which both poses are known:
///
///     T_map_base(now) = T_map_base(then) T_odom_base(then)^-1 T_odom_base(now)
///
/// The translation is computed from the difference of the odom positions, so that it keeps its precision far
/// from the origin of odom.
class PoseAnchor {
 public:
  /// Both poses are of the same time.
  PoseAnchor(const Eigen::Isometry3d& T_map_base, const Eigen::Isometry3d& T_odom_base)
      : R_map_odom_(T_map_base.linear() * T_odom_base.linear().transpose()),
        p_map_base_(T_map_base.translation()),
        p_odom_base_(T_odom_base.translation()) {}

  [[nodiscard]] const Eigen::Matrix3d& R_map_odom() const {  // NOLINT(readability-identifier-naming)
    return R_map_odom_;
  }
  /// Displacement since the anchor [m], axes of the map.
  [[nodiscard]] Eigen::Vector3d step_map_m(const Eigen::Isometry3d& T_odom_base) const {
    return R_map_odom_ * (T_odom_base.translation() - p_odom_base_);
  }
  /// T_map_base at the time of `T_odom_base`.
  [[nodiscard]] Eigen::Isometry3d carried_to(const Eigen::Isometry3d& T_odom_base) const {
    Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
    T_map_base.linear() = R_map_odom_ * T_odom_base.linear();
    T_map_base.translation() = p_map_base_ + step_map_m(T_odom_base);
    return T_map_base;
  }

 private:
  Eigen::Matrix3d R_map_odom_;
  Eigen::Vector3d p_map_base_;
  Eigen::Vector3d p_odom_base_;
};

}  // namespace isobar
