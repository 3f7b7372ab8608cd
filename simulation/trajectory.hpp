// SPDX-License-Identifier: BSD-3-Clause
// Exact motion of base_link.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "simulation/spline.hpp"

namespace isobar::simulation {

/// Exact state of base_link in the world frame (z up, origin defined by the scenario).
struct MotionState {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond q_world_base = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_world = Eigen::Vector3d::Zero();    ///< m/s
  Eigen::Vector3d a_world = Eigen::Vector3d::Zero();    ///< m/s^2
  Eigen::Vector3d w_base = Eigen::Vector3d::Zero();     ///< angular velocity in base_link, rad/s
  Eigen::Vector3d wdot_base = Eigen::Vector3d::Zero();  ///< its derivative, rad/s^2
};

/// Raw sample of a motion, before smoothing. Yaw is unwrapped; |pitch| is at most 80 degrees.
struct RawPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;  ///< positive: nose down (right-handed about y)
  double roll_rad = 0.0;
};

/// Motion from raw poses every SplineGrid::kStepS: position and attitude are C4 functions of time.
class Trajectory {
 public:
  Trajectory() = default;
  explicit Trajectory(const std::vector<RawPose>& raw);

  /// Duration of the motion, which begins at time 0.
  [[nodiscard]] double duration_s() const;
  /// State at `time_s`, clamped to the duration.
  [[nodiscard]] MotionState at(double time_s) const;

 private:
  Channel x_, y_, z_, yaw_, pitch_, roll_;
};

}  // namespace isobar::simulation
