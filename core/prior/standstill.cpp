// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/standstill.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {
namespace {

// A single sample this many times beyond the rms limit ends the standstill at once.
constexpr double kBreakFactor = 6.0;
// Tolerance of the mean rate for the error of the gyro bias.
constexpr double kBiasSigmas = 3.0;
// Fewer samples give no useful variance.
constexpr double kLeastSamples = 8.0;

}  // namespace

void StandstillDetector::clear_sums() {
  gyro_sum_.setZero();
  gyro_square_sum_.setZero();
  force_sum_.setZero();
  force_square_sum_.setZero();
  elapsed_s_ = 0.0;
  count_ = 0.0;
  wheels_moved_ = false;
}

void StandstillDetector::restart() {
  clear_sums();
  standing_ = false;
  window_ready_ = false;
}

void StandstillDetector::add_wheel(double speed_m_s, double turn_rate_rad_s) {
  if (speed_m_s <= config_.max_wheel_speed_m_s && std::abs(turn_rate_rad_s) <= config_.max_wheel_rate_rad_s)
    return;
  wheels_moved_ = true;
  standing_ = false;
}

void StandstillDetector::add_imu(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& gyro_bias_rad_s,
                                 double bias_sigma_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s) {
  gyro_sum_ += gyro_rad_s;
  gyro_square_sum_ += gyro_rad_s.cwiseAbs2();
  force_sum_ += force_m_s2;
  force_square_sum_ += force_m_s2.cwiseAbs2();
  elapsed_s_ += dt_s;
  count_ += 1.0;
  const double limit =
      kBreakFactor * config_.max_gyro_rms_rad_s + config_.max_rate_rad_s + kBiasSigmas * bias_sigma_rad_s;
  if ((gyro_rad_s - gyro_bias_rad_s).cwiseAbs().maxCoeff() > limit) standing_ = false;
  if (elapsed_s_ >= config_.window_s && count_ >= kLeastSamples)
    close_window(gyro_bias_rad_s, bias_sigma_rad_s);
}

void StandstillDetector::close_window(const Eigen::Vector3d& gyro_bias_rad_s, double bias_sigma_rad_s) {
  const Eigen::Vector3d gyro_mean = gyro_sum_ / count_;
  const Eigen::Vector3d force_mean = force_sum_ / count_;
  const double gyro_variance = (gyro_square_sum_ / count_ - gyro_mean.cwiseAbs2()).maxCoeff();
  const double force_variance = (force_square_sum_ / count_ - force_mean.cwiseAbs2()).maxCoeff();
  const double rate = (gyro_mean - gyro_bias_rad_s).cwiseAbs().maxCoeff();
  standing_ = !wheels_moved_ && gyro_variance <= config_.max_gyro_rms_rad_s * config_.max_gyro_rms_rad_s &&
              force_variance <= config_.max_accel_rms_m_s2 * config_.max_accel_rms_m_s2 &&
              rate <= config_.max_rate_rad_s + kBiasSigmas * bias_sigma_rad_s;
  window_ready_ = standing_;
  window_mean_gyro_ = gyro_mean;
  window_gyro_variance_ = std::max(0.0, gyro_variance) / count_;
  window_length_s_ = elapsed_s_;
  clear_sums();
}

bool StandstillDetector::take_window() {
  const bool ready = window_ready_;
  window_ready_ = false;
  return ready;
}

}  // namespace isobar
