// SPDX-License-Identifier: BSD-3-Clause
// Roll and pitch from gravity: a multiplicative (error-state) extended Kalman filter.
//
// Lefferts, Markley, Shuster, "Kalman filtering for spacecraft attitude estimation", 1982; error states as in
// Sola, "Quaternion kinematics for the error-state Kalman filter", 2017, with the angular error in the world
// frame.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/prior/prior_config.hpp"
#include "core/samples.hpp"

namespace isobar {

/// State: rotation world <- base, velocity of the IMU's position in the world, bias of gyro and
/// accelerometer.
///
/// Measurement of gravity: the specific force is integrated to a velocity, which is compared with the wheels'
/// (rotated by the attitude; lever arm of the IMU included), so that accelerations of the motion cancel.
/// Without wheels the pseudo-measurement is zero velocity with the variance of a bounded motion (a pendulum):
/// the tilt then comes from the mean over seconds. All inputs are in base_link's axes.
///
/// World: z up, yaw 0 at the start. Heading is unobservable, so the filter's heading *defines* the world's:
/// the yaw error is zero by definition, the velocity error is expressed in that world, and no update changes
/// the heading. It remains the pure integral of the gyro, as dead reckoning requires. (A yaw error in the
/// state would be correlated with the gyro bias; the first standstill after minutes of driving would then
/// turn the robot by degrees in one step.)
///
/// Error state: [angle (world; its z is 0), velocity (world), gyro bias, accel bias] (base axes).
class AttitudeFilter {
 public:
  static constexpr int kStates = 12;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  /// `p_base_imu`: position of the IMU in base_link [m].
  AttitudeFilter(const AttitudeConfig& config, const Eigen::Vector3d& p_base_imu);

  /// Roll and pitch from the direction of a specific force (any scale), yaw as given [rad]; `sigma_rad` of
  /// roll and of pitch. A restart keeps the biases and their covariance.
  void start(const Eigen::Vector3d& up_force, double yaw_rad, double sigma_rad);
  [[nodiscard]] bool started() const { return started_; }
  /// Attitude lost, until the next start(). Keeps the biases.
  void stop() { started_ = false; }

  /// Prediction over `dt_s` (> 0) from the measured rate and specific force. Variances of one sample, white
  /// noise [rad^2/s^2, m^2/s^4].
  void predict(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& force_m_s2, double dt_s,
               double gyro_variance, double accel_variance);

  /// Prediction over a gap of `dt_s` from the turn during it (base axes) and its standard deviation.
  void bridge(const Eigen::Vector3d& turn_rad, double dt_s, double turn_sigma_rad);

  /// Wheel velocity of base_link, mean over the last `dt_s`, its variances believed (wheel_noise.hpp).
  /// @param use_vertical also the non-holonomic constraint vz = 0, which does not hold while the ground moves
  ///        (elevator)
  /// @return false when a horizontal speed lay outside of the gate, and was not used
  bool update_wheels(const WheelSample& wheels, double dt_s, bool use_vertical);

  /// Without wheels: zero velocity with the variance of a bounded motion, over the last `dt_s`.
  void update_bounded_velocity(double dt_s);

  /// Zero-rate update: the mean gyro reading of a standing robot over the last `dt_s` is the bias.
  void update_zero_rate(const Eigen::Vector3d& mean_gyro_rad_s, double dt_s, double gyro_variance_of_mean);

  /// Gravity of a robot at rest: its mean specific force (base axes, any scale), with the variance of an axis
  /// [m^2/s^4].
  void update_rest(const Eigen::Vector3d& up_force, double variance);

  /// The mean gyro reading over a window in which the platform did not turn about level axes: their part of the bias.
  void update_level_rate(const Eigen::Vector3d& mean_gyro_rad_s, double variance);

  /// Up direction of the IMU's own attitude, unit vector in base axes, over the last `dt_s`.
  void update_up_direction(const Eigen::Vector3d& up_base, double dt_s);

  /// Measured gyro bias [rad/s].
  void update_gyro_bias(const Eigen::Vector3d& bias_rad_s, double sigma_rad_s);

  [[nodiscard]] const Eigen::Quaterniond& q_world_base() const { return q_world_base_; }
  /// Velocity of the IMU's position, in the world.
  [[nodiscard]] const Eigen::Vector3d& velocity_m_s() const { return velocity_; }
  [[nodiscard]] const Eigen::Vector3d& accel_bias_m_s2() const { return accel_bias_; }
  [[nodiscard]] const Eigen::Vector3d& rate_rad_s() const { return rate_rad_s_; }  ///< bias removed
  [[nodiscard]] const Eigen::Vector3d& gyro_bias_rad_s() const { return gyro_bias_; }
  [[nodiscard]] double roll_pitch_variance_rad2() const { return 0.5 * (P_(0, 0) + P_(1, 1)); }
  [[nodiscard]] double yaw_rate_variance_rad2_s2() const { return P_(8, 8) + rate_noise_variance_; }
  [[nodiscard]] double gyro_bias_variance(int axis) const { return P_(6 + axis, 6 + axis); }

 private:
  using Row = Eigen::Matrix<double, 1, kStates>;

  /// Kalman update with the scalar measurement `residual` = H x + noise. False if it lies outside the gate.
  bool update(const Row& H, double residual, double variance, double gate_sigma);
  void apply(const Eigen::Matrix<double, kStates, 1>& error);
  void turn_world_with_heading();
  void propagate_covariance(const Eigen::Vector3d& force_world, double dt_s);

  AttitudeConfig config_;
  Eigen::Vector3d p_base_imu_;
  Eigen::Quaterniond q_world_base_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();
  Covariance P_ = Covariance::Zero();
  double rate_noise_variance_ = 0.0;
  double gated_s_ = 0.0;  // how long the wheels have been outside the gate
  bool started_ = false;
  bool biases_started_ = false;
};

}  // namespace isobar
