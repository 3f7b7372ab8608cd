// SPDX-License-Identifier: BSD-3-Clause
// Standstill detection: gyro, accelerometer and wheels must agree. Without wheels it is undecidable: a sphere
// lowered on a rope moves and turns so evenly that its IMU reads the same as on the ground.
#pragma once

#include <Eigen/Core>

#include "core/prior/prior_config.hpp"

namespace isobar {

/// Judges consecutive windows; the result of a window holds until a sample contradicts it.
class StandstillDetector {
 public:
  explicit StandstillDetector(const StandstillConfig& config) : config_(config) {}

  void configure(const StandstillConfig& config) { config_ = config; }

  /// One IMU sample, base axes. `bias_sigma_rad_s`: standard deviation of the gyro bias. Of `force_m_s2` only
  /// the variance within a window counts.
  void add_imu(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& gyro_bias_rad_s,
               double bias_sigma_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s);
  void add_wheel(double speed_m_s, double turn_rate_rad_s);
  /// After a gap: not standing until the next full window.
  void restart();

  [[nodiscard]] bool standing() const { return standing_; }
  /// True once per quiet window; mean_gyro_rad_s(), window_s() and gyro_variance_of_mean() are that window's.
  bool take_window();
  [[nodiscard]] const Eigen::Vector3d& mean_gyro_rad_s() const { return window_mean_gyro_; }
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
