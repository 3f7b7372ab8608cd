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
// Factors on the limits of rms where wheels stand: an engine idles, gusts shake. A robot that is carried turns more.
constexpr double kShakenGyro = 5.0;
constexpr double kShakenForce = 3.0;
// Correlation of neighbouring parts of a window, as a factor on the variance of their mean.
constexpr double kCorrelated = 2.0;
// Least standard deviation of a window's mean force [m/s^2]: 0.06 deg, half an hour's wander of a MEMS.
constexpr double kLeastForceSigmaMS2 = 0.01;

}  // namespace

void StandstillDetector::clear_sums() {
  gyro_sum_.setZero();
  gyro_square_sum_.setZero();
  force_sum_.setZero();
  force_square_sum_.setZero();
  elapsed_s_ = 0.0;
  count_ = 0.0;
  part_sum_.setZero();
  parts_sum_.setZero();
  parts_square_sum_.setZero();
  part_count_ = 0.0;
  parts_ = 0;
  wheels_moved_ = false;
}

void StandstillDetector::restart() {
  clear_sums();
  standing_ = resting_ = false;
  window_ready_ = rest_ready_ = false;
}

void StandstillDetector::add_wheel(double speed_m_s, double turn_rate_rad_s) {
  if (speed_m_s <= config_.max_wheel_speed_m_s && std::abs(turn_rate_rad_s) <= config_.max_wheel_rate_rad_s)
    return;
  wheels_moved_ = true;
  standing_ = resting_ = may_stand_ = false;
}

void StandstillDetector::add_imu(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& gyro_bias_rad_s,
                                 double bias_sigma_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s) {
  gyro_sum_ += gyro_rad_s;
  gyro_square_sum_ += gyro_rad_s.cwiseAbs2();
  force_sum_ += force_m_s2;
  force_square_sum_ += force_m_s2.cwiseAbs2();
  part_sum_ += force_m_s2;
  part_count_ += 1.0;
  elapsed_s_ += dt_s;
  count_ += 1.0;
  if (elapsed_s_ * kParts >= config_.window_s * (parts_ + 1)) close_part();
  const double limit =
      kBreakFactor * config_.max_gyro_rms_rad_s + config_.max_rate_rad_s + kBiasSigmas * bias_sigma_rad_s;
  if ((gyro_rad_s - gyro_bias_rad_s).cwiseAbs().maxCoeff() > limit) {
    standing_ = may_stand_ = false;
  }
  if (elapsed_s_ >= config_.window_s && count_ >= kLeastSamples)
    close_window(gyro_bias_rad_s, bias_sigma_rad_s);
}

void StandstillDetector::close_part() {
  const Eigen::Vector3d mean = part_sum_ / part_count_;
  parts_sum_ += mean;
  parts_square_sum_ += mean.cwiseAbs2();
  ++parts_;
  part_sum_.setZero();
  part_count_ = 0.0;
}

void StandstillDetector::close_rest(double gyro_variance, double force_variance, double rate_rad_s,
                                    double rate_limit_rad_s) {
  const double gyro_limit = kShakenGyro * config_.max_gyro_rms_rad_s;
  const double force_limit = kShakenForce * config_.max_accel_rms_m_s2;
  resting_ = !wheels_moved_ && gyro_variance <= gyro_limit * gyro_limit &&
             force_variance <= force_limit * force_limit && rate_rad_s <= rate_limit_rad_s && parts_ > 1;
  rest_ready_ = resting_;
  if (!resting_) return;
  const double n = parts_;
  const Eigen::Vector3d scatter = (parts_square_sum_ - parts_sum_.cwiseAbs2() / n).cwiseMax(0.0) / (n - 1.0);
  rest_.force_m_s2 = force_sum_ / count_;
  rest_.gyro_rad_s = gyro_sum_ / count_;
  rest_.force_variance = kCorrelated * scatter.mean() / n + kLeastForceSigmaMS2 * kLeastForceSigmaMS2;
}

bool StandstillDetector::take_rest(Rest& out) {
  const bool ready = rest_ready_;
  rest_ready_ = false;
  if (ready) out = rest_;
  return ready;
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
  close_rest(gyro_variance, force_variance, rate, config_.max_rate_rad_s + kBiasSigmas * bias_sigma_rad_s);
  window_ready_ = may_stand_ = standing_;
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
