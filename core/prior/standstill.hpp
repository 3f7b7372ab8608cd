// SPDX-License-Identifier: BSD-3-Clause
// Does the robot stand still? Gyro, accelerometer and wheels must all say so. Without wheels nobody can tell:
// a sphere on a rope is lowered and turns as evenly as if it lay on the ground.
#pragma once

#include <Eigen/Core>

#include "core/prior/prior_config.hpp"

namespace isobar {

/// Looks at windows that follow each other; the answer of a full window holds until a sample contradicts it.
class StandstillDetector {
 public:
  explicit StandstillDetector(const StandstillConfig& config) : config_(config) {}

  /// `bias_sigma_rad_s`: how well the gyro bias is known. Base axes. `force` may rotate freely: only its
  /// spread counts.
  void add_imu(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& gyro_bias_rad_s,
               double bias_sigma_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s);
  void add_wheel(double speed_m_s, double turn_rate_rad_s);
  /// A gap: nothing is known of what happened in it.
  void restart();

  [[nodiscard]] bool standing() const { return standing_; }
  /// True once for each full quiet window: mean_gyro() and window_s() are then those of that window.
  bool take_window();
  [[nodiscard]] const Eigen::Vector3d& mean_gyro() const { return window_mean_gyro_; }
  [[nodiscard]] double window_s() const { return window_length_s_; }
  [[nodiscard]] double gyro_variance_of_mean() const { return window_gyro_variance_; }

 private:
  void close_window(const Eigen::Vector3d& gyro_bias_rad_s, double bias_sigma_rad_s);
  void clear_sums();

  StandstillConfig config_;
  Eigen::Vector3d gyro_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_square_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_square_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d window_mean_gyro_ = Eigen::Vector3d::Zero();
  double window_gyro_variance_ = 0.0;
  double window_length_s_ = 0.0;
  double elapsed_s_ = 0.0;
  double count_ = 0.0;
  bool wheels_moved_ = false;
  bool standing_ = false;
  bool window_ready_ = false;
};

}  // namespace isobar
