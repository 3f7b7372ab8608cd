// SPDX-License-Identifier: BSD-3-Clause
// Error of dead reckoning since the last scan that showed the pose.
//
//     wheels:     scale x way, slip x sqrt(way)                 gyro: bias x time
//     no wheels:  an unknown velocity x time, which is the last one at first
#pragma once

#include <Eigen/Core>

#include "core/estimates.hpp"
#include "core/registration/growing_error.hpp"

namespace isobar {

/// Constant error of the wheels' scale, 1 sigma: radius, load, slip on one ground.
inline constexpr double kWheelScaleError = 0.015;

/// A step of dead reckoning.
struct UnseenStep {
  Eigen::Vector3d step_m = Eigen::Vector3d::Zero();  ///< axes of the map
  Eigen::Matrix3d R_map_base = Eigen::Matrix3d::Identity();
  double dt_s = 0.0;
  double tilt_rad =
      0.0;  ///< constant error of roll and pitch in axes of base_link, 1 sigma: wheels roll up a slope
};

/// Covariance of the error that dead reckoning has added. Allocates nothing.
class DeadReckoningError {
 public:
  /// A scan has shown the pose; the robot moves at `v_map_m_s`.
  void restart(const Eigen::Vector3d& v_map_m_s = Eigen::Vector3d::Zero());
  /// `prior`: at the end of the step.
  void move(const Prior& prior, const UnseenStep& step);

  [[nodiscard]] Matrix6d covariance() const;
  [[nodiscard]] double way_m() const { return way_m_; }
  [[nodiscard]] double time_s() const { return time_s_; }

 private:
  void turn(const Prior& prior, double dt_s);
  void roll(const UnseenStep& step);
  void drift_freely(double velocity_sigma_m_s, double dt_s);

  GrowingError error_;
  Eigen::Vector3d v_map_m_s_ = Eigen::Vector3d::Zero();
  double free_variance_m2_ = 0.0;  // of each axis, from the time without wheels
  double going_on_m_ = 0.0;        // way at the last velocity
  double free_s_ = 0.0;
  double way_m_ = 0.0;
  double time_s_ = 0.0;
};

}  // namespace isobar
