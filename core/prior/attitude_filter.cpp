// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/attitude_filter.hpp"

#include <algorithm>
#include <cmath>

#include "core/prior/wheel_noise.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// First row of each part of the error state.
constexpr int kAngle = 0;
constexpr int kYaw = 2;
constexpr int kVelocity = 3;
constexpr int kGyroBias = 6;
constexpr int kAccelBiasRow = 9;

// Innovation gates in standard deviations; the last one is wide open, for pseudo-measurements, which have no
// outliers.
constexpr double kWheelGateSigmas = 5.0;
constexpr double kBiasGateSigmas = 5.0;
constexpr double kNoGateSigmas = 1e3;
// Time with the wheels outside the gate after which the filter's velocity counts as wrong, not the wheels.
constexpr double kGatedLimitS = 1.0;
// Variance added to the velocity then, and its initial variance: (1 m/s)^2.
constexpr double kUnknownVelocityM2S2 = 1.0;
// Correlation time of vibration and sensor noise: both are white over longer intervals only.
constexpr double kNoiseCorrelationS = 0.005;
// Time over which Prior::yaw_rate_variance_rad2_s2 averages the gyro's noise: one scan.
constexpr double kRateMeanS = 0.1;
// Rocking of a standing robot: 1 sigma and correlation time.
constexpr double kRockingRadS = 1e-4;
constexpr double kRockingS = 1.0;
// Factor on the variance of the vertical velocity without wheels: a hanging load is lowered steadily for
// minutes, so its mean is not zero.
constexpr double kVerticalVarianceFactor = 100.0;

}  // namespace

AttitudeFilter::AttitudeFilter(const AttitudeConfig& config, const Eigen::Vector3d& p_base_imu)
    : config_(config), p_base_imu_(p_base_imu) {}

void AttitudeFilter::start(const Eigen::Vector3d& up_force, double yaw_rad, double sigma_rad) {
  const Eigen::Quaterniond tilt = Eigen::Quaterniond::FromTwoVectors(up_force, Eigen::Vector3d::UnitZ());
  const Eigen::Quaterniond turn = exp_so3({0.0, 0.0, yaw_rad - yaw_of(tilt)});
  q_world_base_ = (turn * tilt).normalized();
  velocity_.setZero();
  P_.topRows<6>().setZero();
  P_.leftCols<6>().setZero();
  P_(0, 0) = P_(1, 1) = squared(sigma_rad);
  P_.diagonal().segment<3>(kVelocity).setConstant(kUnknownVelocityM2S2);
  if (!biases_started_) {
    P_.diagonal().segment<3>(kGyroBias).setConstant(squared(config_.gyro_bias_sigma_rad_s));
    P_.diagonal().segment<3>(kAccelBiasRow).setConstant(squared(config_.accel_bias_sigma_m_s2));
    biases_started_ = true;
  }
  gated_s_ = 0.0;
  started_ = true;
}

void AttitudeFilter::propagate_covariance(const Eigen::Vector3d& force_world, double dt_s) {
  // d(angle)/dt = -R d(gyro bias); d(velocity)/dt = -[R f]x angle - R d(accel bias). First order in dt.
  const Eigen::Matrix3d R = q_world_base_.toRotationMatrix();
  Covariance F = Covariance::Identity();
  F.block<3, 3>(kAngle, kGyroBias) = -dt_s * R;
  F.block<3, 3>(kVelocity, kAngle) = -dt_s * skew(force_world);
  F.block<3, 3>(kVelocity, kAccelBiasRow) = -dt_s * R;
  const Covariance FP = F * P_;
  P_.noalias() = FP * F.transpose();
}

void AttitudeFilter::predict(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& force_m_s2,
                             double dt_s, double gyro_variance, double accel_variance) {
  rate_rad_s_ = gyro_rad_s - gyro_bias_;
  const Eigen::Quaterniond half = exp_so3(rate_rad_s_ * (0.5 * dt_s));
  const Eigen::Vector3d force_world = (q_world_base_ * half) * (force_m_s2 - accel_bias_);
  propagate_covariance(force_world, dt_s);
  q_world_base_ = (q_world_base_ * half * half).normalized();
  velocity_ += (force_world - Eigen::Vector3d(0.0, 0.0, kGravity)) * dt_s;

  const double correlation_s = std::max(dt_s, kNoiseCorrelationS);
  const double gyro_density = std::max(squared(config_.gyro_noise_rad_sqrt_s), gyro_variance * dt_s);
  const double accel_density =
      std::max(squared(config_.accel_noise_m_s_sqrt_s), accel_variance * correlation_s);
  P_.diagonal().segment<3>(kAngle).array() += gyro_density * dt_s;
  P_.diagonal().segment<3>(kVelocity).array() += accel_density * dt_s;
  P_.diagonal().segment<3>(kGyroBias).array() += squared(config_.gyro_bias_walk_rad_s_sqrt_s) * dt_s;
  P_.diagonal().segment<3>(kAccelBiasRow).array() += squared(config_.accel_bias_walk_m_s2_sqrt_s) * dt_s;
  turn_world_with_heading();
  rate_noise_variance_ = gyro_density / kRateMeanS;
}

void AttitudeFilter::turn_world_with_heading() {
  // In a world turned by the yaw error a the velocity error is dv - a (e_z x v) and the yaw error is zero.
  P_.row(kVelocity) += velocity_.y() * P_.row(kYaw);
  P_.row(kVelocity + 1) -= velocity_.x() * P_.row(kYaw);
  P_.col(kVelocity) += velocity_.y() * P_.col(kYaw);
  P_.col(kVelocity + 1) -= velocity_.x() * P_.col(kYaw);
  P_.row(kYaw).setZero();
  P_.col(kYaw).setZero();
}

void AttitudeFilter::bridge(const Eigen::Vector3d& turn_rad, double dt_s, double turn_sigma_rad) {
  q_world_base_ = (q_world_base_ * exp_so3(turn_rad)).normalized();
  P_.diagonal().segment<3>(kAngle).array() += squared(turn_sigma_rad);
  P_.diagonal().segment<3>(kVelocity).array() += squared(std::min(dt_s, 1.0));
  turn_world_with_heading();
}

bool AttitudeFilter::update_wheels(const WheelSample& wheels, double dt_s, bool use_vertical) {
  const Eigen::Vector3d measured(wheels.vx_m_s, wheels.vy_m_s, 0.0);
  const double speed = std::hypot(wheels.vx_m_s, wheels.vy_m_s);
  const double share = squared(config_.wheel_sigma_share * speed);
  const Eigen::Vector3d variance(
      constant_variance(wheels.vx_variance_m2_s2, config_.wheel_sigma_m_s) + share,
      constant_variance(wheels.vy_variance_m2_s2, config_.lateral_sigma_m_s) + share,
      squared(config_.vertical_sigma_m_s) + share);
  // A correlated error of variance s^2 and correlation time c has the density of white noise 2 c s^2.
  const double white = std::max(1.0, 2.0 * config_.wheel_correlation_s / dt_s);
  bool agreed = true;
  for (int axis = 0; axis < (use_vertical ? 3 : 2); ++axis) {
    // v_base = R^T v - rate x r, evaluated anew after the update of each axis.
    const Eigen::Matrix3d R_now = q_world_base_.toRotationMatrix().transpose();
    const Eigen::Vector3d predicted = R_now * velocity_ - rate_rad_s_.cross(p_base_imu_);
    Row H = Row::Zero();
    H.segment<3>(kAngle) = (R_now * skew(velocity_)).row(axis);
    H.segment<3>(kVelocity) = R_now.row(axis);
    H.segment<3>(kGyroBias) = -skew(p_base_imu_).row(axis);
    const bool used = update(H, measured[axis] - predicted[axis], variance[axis] * white, kWheelGateSigmas);
    agreed = agreed && (used || axis == 2);
  }
  gated_s_ = agreed ? 0.0 : gated_s_ + dt_s;
  if (gated_s_ > kGatedLimitS) {
    P_.diagonal().segment<3>(kVelocity).array() += kUnknownVelocityM2S2;
    gated_s_ = 0.0;
  }
  return agreed;
}

void AttitudeFilter::update_bounded_velocity(double dt_s) {
  const double variance = squared(config_.free_velocity_sigma_m_s) *
                          std::max(1.0, 2.0 * config_.free_velocity_correlation_s / dt_s);
  for (int axis = 0; axis < 3; ++axis) {
    Row H = Row::Zero();
    H(kVelocity + axis) = 1.0;
    update(H, -velocity_[axis], axis == 2 ? kVerticalVarianceFactor * variance : variance, kNoGateSigmas);
  }
}

void AttitudeFilter::update_zero_rate(const Eigen::Vector3d& mean_gyro_rad_s, double dt_s,
                                      double gyro_variance_of_mean) {
  const double variance =
      gyro_variance_of_mean + squared(kRockingRadS) * std::max(1.0, 2.0 * kRockingS / dt_s);
  update_gyro_bias(mean_gyro_rad_s, std::sqrt(variance));
}

void AttitudeFilter::update_gyro_bias(const Eigen::Vector3d& bias_rad_s, double sigma_rad_s) {
  for (int axis = 0; axis < 3; ++axis) {
    Row H = Row::Zero();
    H(kGyroBias + axis) = 1.0;
    update(H, bias_rad_s[axis] - gyro_bias_[axis], squared(sigma_rad_s), kBiasGateSigmas);
  }
}

void AttitudeFilter::update_rest(const Eigen::Vector3d& up_force, double variance) {
  // f = R^T g e_z + bias. Of the length only g is used: it differs with the place by as much as the bias.
  const Eigen::Vector3d measured = kGravity * up_force.normalized();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix3d R_base_world = q_world_base_.toRotationMatrix().transpose();
    Row H = Row::Zero();
    H.segment<3>(kAngle) = kGravity * (R_base_world * skew(Eigen::Vector3d::UnitZ())).row(axis);
    H(kAccelBiasRow + axis) = 1.0;
    const double predicted = kGravity * R_base_world(axis, 2) + accel_bias_[axis];
    update(H, measured[axis] - predicted, variance, kNoGateSigmas);
  }
}

void AttitudeFilter::update_level_rate(const Eigen::Vector3d& mean_gyro_rad_s, double variance) {
  const Eigen::Matrix3d R_base_world = q_world_base_.toRotationMatrix().transpose();
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d level = R_base_world.col(axis);
    Row H = Row::Zero();
    H.segment<3>(kGyroBias) = level.transpose();
    update(H, level.dot(mean_gyro_rad_s - gyro_bias_), variance, kBiasGateSigmas);
  }
}

void AttitudeFilter::update_up_direction(const Eigen::Vector3d& up_base, double dt_s) {
  const double variance = squared(config_.imu_attitude_sigma_rad) *
                          std::max(1.0, 2.0 * config_.imu_attitude_correlation_s / dt_s);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix3d R_base_world = q_world_base_.toRotationMatrix().transpose();
    // up = R^T e_z: an error of angle a changes it by R^T (e_z x a).
    Row H = Row::Zero();
    H.segment<3>(kAngle) = (R_base_world * skew(Eigen::Vector3d::UnitZ())).row(axis);
    update(H, up_base[axis] - R_base_world(axis, 2), variance, kNoGateSigmas);
  }
}

bool AttitudeFilter::update(const Row& H, double residual, double variance, double gate_sigma) {
  const Eigen::Matrix<double, kStates, 1> PH = P_ * H.transpose();
  const double S = (H * PH)(0) + variance;
  if (!(residual * residual <= gate_sigma * gate_sigma * S)) return false;
  const Eigen::Matrix<double, kStates, 1> K = PH / S;
  apply(K * residual);
  P_.noalias() -= K * PH.transpose();
  // Rounding errors: restore the symmetry, clamp the variances at zero.
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  P_.diagonal() = P_.diagonal().cwiseMax(0.0);
  return true;
}

void AttitudeFilter::apply(const Eigen::Matrix<double, kStates, 1>& error) {
  q_world_base_ = (exp_so3(error.segment<3>(kAngle)) * q_world_base_).normalized();
  velocity_ += error.segment<3>(kVelocity);
  gyro_bias_ += error.segment<3>(kGyroBias);
  accel_bias_ += error.segment<3>(kAccelBiasRow);
}

}  // namespace isobar
