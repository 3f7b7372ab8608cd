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

  /// A window in which the wheels, if there are any, stood and nothing turned; shaken more than a standstill at most
  /// by an engine.
  struct Rest {
    Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();  ///< mean
    Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();  ///< mean
    /// Variance of an axis of the mean force [m^2/s^4], from the scatter of the means of four parts of the window: an
    /// engine's lines above 5 Hz average out much faster than white noise of the same rms, rocking does not.
    double force_variance = 0.0;
  };

  void configure(const StandstillConfig& config) { config_ = config; }

  /// One IMU sample, base axes. `bias_sigma_rad_s`: standard deviation of the gyro bias. Of `force_m_s2` only
  /// the variance within a window counts.
  void add_imu(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& gyro_bias_rad_s,
               double bias_sigma_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s);
  void add_wheel(double speed_m_s, double turn_rate_rad_s);
  /// After a gap: not standing until the next full window.
  void restart();

  [[nodiscard]] bool standing() const { return standing_; }
  /// False while something moves; true as well before the first window has been judged.
  [[nodiscard]] bool may_stand() const { return may_stand_; }
  /// True once per quiet window; mean_gyro_rad_s(), window_s() and gyro_variance_of_mean() are that window's.
  bool take_window();
  /// True once per window of rest.
  bool take_rest(Rest& out);
  /// The last window was one of rest, and nothing has moved since.
  [[nodiscard]] bool resting() const { return resting_; }
  [[nodiscard]] const Eigen::Vector3d& mean_gyro_rad_s() const { return window_mean_gyro_; }
  [[nodiscard]] double window_s() const { return window_length_s_; }
  [[nodiscard]] double gyro_variance_of_mean() const { return window_gyro_variance_; }

 private:
  void close_window(const Eigen::Vector3d& gyro_bias_rad_s, double bias_sigma_rad_s);
  void clear_sums();
  void close_part();
  void close_rest(double gyro_variance, double force_variance, double rate_rad_s, double rate_limit_rad_s);

  static constexpr int kParts = 4;

  StandstillConfig config_;
  Rest rest_;
  Eigen::Vector3d part_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d parts_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d parts_square_sum_ = Eigen::Vector3d::Zero();
  double part_count_ = 0.0;
  int parts_ = 0;
  bool resting_ = false;
  bool rest_ready_ = false;
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
  bool may_stand_ = true;
  bool window_ready_ = false;
};

}  // namespace isobar
