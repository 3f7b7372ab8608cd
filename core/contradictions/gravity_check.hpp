// SPDX-License-Identifier: BSD-3-Clause
// Gravity against the configured mount of the IMU, from means of the specific force over a second.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/contradictions/finding.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Roll and pitch in right angles, with the configured yaw, that bring `up_imu` nearest to up: rpy [deg].
Eigen::Vector3d right_angled_mount(const Eigen::Vector3d& up_imu, double configured_yaw_deg);

/// Judges the first seconds. Allocates nothing.
///
/// A second's mean of the specific force is gravity within what a robot accelerates: 3 m/s^2 tilt it by 17 deg, a ramp by
/// 20, a curve by less: 45 deg are a mount. Its length is 9.8 within a third; one within a quarter of 1 is g.
class GravityCheck {
 public:
  explicit GravityCheck(const Eigen::Vector3d& imu_rpy_deg);
  void add(const ImuSample& sample);

  /// Enough seconds have been seen for a verdict that stays: a robot that falls over later has its mounts as ever.
  [[nodiscard]] bool settled() const { return windows_ >= kWindows; }
  [[nodiscard]] std::optional<Finding> mount() const;
  [[nodiscard]] std::optional<Finding> unit() const;
  /// Gravity is nearer to straight down than to the side.
  [[nodiscard]] bool points_down() const;

 private:
  static constexpr std::int64_t kWindowNs = 1'000'000'000;
  static constexpr int kLeastWindows = 2;
  static constexpr int kWindows = 5;
  static constexpr int kLeastSamples = 10;

  void end_window();
  [[nodiscard]] double angle_from_up_deg() const;

  Eigen::Vector3d imu_rpy_deg_;
  Eigen::Matrix3d R_base_imu_;
  std::int64_t begin_ns_ = 0;  // of the window under way; 0: none
  Eigen::Vector3d sum_m_s2_ = Eigen::Vector3d::Zero();
  int samples_ = 0;
  int windows_ = 0;
  int tilted_ = 0;  // windows beyond 45 deg
  int in_g_ = 0;    // windows of length 1
  double length_sum_ = 0.0;
  Eigen::Vector3d up_sum_imu_ = Eigen::Vector3d::Zero();  // of the windows' directions
};

}  // namespace isobar
