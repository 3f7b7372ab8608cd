// SPDX-License-Identifier: BSD-3-Clause
// Settings of the prior stage: each with its unit and the reason for its default. Ranges are in the settings
// table (config/).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/sensor_compensation.hpp"

namespace isobar {

/// Attitude and velocity from gyro, accelerometer and wheels (attitude_filter.hpp).
struct AttitudeConfig {
  /// Duration of the alignment [s]: roll and pitch start from the mean specific force over it. A compromise
  /// of averaging vibration (1 m/s^2 rms at 200 Hz over 0.5 s leaves 0.6 deg, which the filter then reduces)
  /// and starting soon.
  double start_time_s = 0.5;

  /// Turn-on bias of each gyro axis, 1 sigma [rad/s]. 0.5 deg/s is a consumer-to-industrial MEMS.
  double gyro_bias_sigma_rad_s = 0.0087;
  /// Random walk of the gyro bias [rad/s/sqrt(s)]. 10 deg/h in-run stability over some minutes.
  double gyro_bias_walk_rad_s_sqrt_s = 3e-6;
  /// Floor of the gyro's angle random walk [rad/sqrt(s)]; raised online where the gyro is noisier.
  /// 0.015 deg/s/sqrt(Hz) lies between a VN-100 (0.0035) and an MTi-10 (0.03).
  double gyro_noise_rad_sqrt_s = 2.6e-4;

  /// Bias of each accelerometer axis, 1 sigma [m/s^2], and its walk [m/s^2/sqrt(s)]. 0.03 is 3 mg,
  /// 0.18 deg of roll or pitch; turning on the spot makes it observable.
  double accel_bias_sigma_m_s2 = 0.03;
  double accel_bias_walk_m_s2_sqrt_s = 2e-5;
  /// Floor of the accelerometer's velocity random walk [m/s/sqrt(s)]; raised online by vibration.
  double accel_noise_m_s_sqrt_s = 0.003;

  /// Error of the wheel speed: constant part [m/s] and share of the speed, 1 sigma. Tracks slip by per cents.
  double wheel_sigma_m_s = 0.03;
  double wheel_sigma_share = 0.05;
  /// Correlation time of the wheel's error [s], since slip lasts: makes the filter independent of the sample
  /// rate.
  double wheel_correlation_s = 0.5;
  /// Sideways and vertical slip of base_link, 1 sigma [m/s] (non-holonomic constraint).
  double lateral_sigma_m_s = 0.05;
  double vertical_sigma_m_s = 0.1;

  /// Bounded velocity of a platform without wheels: rms [m/s] and correlation time [s]. A pendulum of 0.5 m
  /// amplitude on 10 to 30 m of rope swings with 0.3 to 0.5 m/s.
  double free_velocity_sigma_m_s = 0.5;
  double free_velocity_correlation_s = 3.0;

  /// Use the IMU's own attitude: its roll and pitch as measurements, its rate to measure the gyro bias. Off
  /// by default: the behaviour of a device's filter in an elevator or on stairs is undocumented.
  bool use_imu_attitude = false;
  /// Error of the IMU's own roll and pitch, 1 sigma [rad], and its correlation time [s].
  double imu_attitude_sigma_rad = 0.007;
  double imu_attitude_correlation_s = 2.0;
};

/// Standstill detection (standstill.hpp).
struct StandstillConfig {
  /// Length of the window in which all sensors must be quiet [s].
  double window_s = 0.6;
  /// Upper limit of the rms about the mean, per axis, of angular rate [rad/s] and specific force [m/s^2]. The
  /// gyro decides; 1.5 m/s^2 tolerates the shaking of fans and a running engine (1 m/s^2) at standstill.
  double max_gyro_rms_rad_s = 0.02;
  double max_accel_rms_m_s2 = 1.5;
  /// Upper limit of the mean rate, minus the estimated bias [rad/s]: no robot turns slower.
  double max_rate_rad_s = 0.02;
  /// Wheel speed [m/s] and turn rate [rad/s] below which the wheels count as standing.
  double max_wheel_speed_m_s = 0.005;
  double max_wheel_rate_rad_s = 0.01;
};

/// Dead reckoning with wheels (dead_reckoning.hpp).
struct DeadReckoningConfig {
  /// Timeout of the wheels [s]: silent for longer, they are lost.
  double wheel_timeout_s = 0.5;
  /// Plausible range of wheel speed [m/s], turn rate [rad/s], and acceleration between samples [m/s^2]:
  /// beyond are faults of the encoder or the link.
  double max_speed_m_s = 10.0;
  double max_turn_rate_rad_s = 15.0;
  double max_acceleration_m_s2 = 30.0;
};

/// The vertical Kalman filter (height_filter.hpp).
struct HeightConfig {
  /// Bias of the vertical acceleration, 1 sigma [m/s^2], and its walk [m/s^2/sqrt(s)]: accelerometer
  /// bias, local gravity (9.780 … 9.832 against 9.80665) and tilt error together.
  double accel_bias_sigma_m_s2 = 0.05;
  double accel_bias_walk_m_s2_sqrt_s = 3e-4;
  /// Floor of the noise of the vertical acceleration [m/s/sqrt(s)]; raised online by vibration.
  double accel_noise_m_s_sqrt_s = 0.003;

  /// Angle between the rolling direction of the wheels and base_link's x-y plane by the attitude filter, 1
  /// sigma [rad], and its walk [rad/sqrt(s)]. 0.23 deg: 0.1 of mounting and 2 to 4 mg of accelerometer bias.
  double slope_sigma_rad = 0.004;
  double slope_walk_rad_sqrt_s = 2e-5;
  /// Correlated error of the slope (attitude, suspension, uneven floor), 1 sigma [rad], and its correlation
  /// time [s].
  double slope_error_rad = 0.002;
  double slope_error_correlation_s = 3.0;
  /// Relative error of the climb speed (slip on stairs), 1 sigma, and its correlation time [s].
  double slip_share = 0.1;
  double slip_correlation_s = 3.0;
  /// Error of the climb speed at standstill [m/s/sqrt(Hz)]: the ground yields a little.
  double rest_speed_m_s_sqrt_s = 3e-4;

  /// Local slow pressure noise (turbulence, ventilation, doors), as a height: rms [m] and correlation time
  /// [s]. 0.5 Pa over 10 s: twice the difference of two good barometers in still air after averaging their
  /// white noise, because the air in buildings moves.
  double turbulence_sigma_m = 0.04;
  double turbulence_time_s = 10.0;

  /// Time from the first pressure in which the offset between the two barometers is estimated [s]; constant
  /// afterwards. Long enough to average turbulence; short enough that no ventilation zone entered later
  /// becomes part of the offset, which would shift all heights for good.
  double offset_learning_s = 15.0;
  /// Weather without a base station: its rate, 1 sigma [m/s], and a random walk [m/sqrt(s)]. Fronts change
  /// the pressure by 1 to 4 hPa in three hours, in one direction for hours: 0.025 Pa/s rms; 1 Pa is 8.5 cm.
  /// The walk is that of open air, 0.05 to 0.2 Pa/sqrt(s), plus gusts of 0.3 to 1 Pa over a minute, which no
  /// base station cancels: 0.2 Pa/sqrt(s) together. After 120 s the standard deviation is 32 cm, after ten
  /// minutes 1.4 m.
  double weather_rate_m_s = 0.0021;
  double weather_walk_m_sqrt_s = 0.018;

  /// Unobservable warm-up drift of two barometers: 1 sigma [m] and time constant [s]. Only added to the
  /// reported variance: as a state of the filter it would absorb pressure that corrects the wheels' errors.
  double warm_up_sigma_m = 0.05;
  double warm_up_time_s = 300.0;
  /// Unobservable pressure difference between ventilated zones, 1 sigma [m]: 0.3 to 1 Pa; 2 to 35 cm in the
  /// paper's runs. Only added to the reported variance, over the first minute.
  double zone_sigma_m = 0.05;

  /// Correction of the reported height by the weather when a lost base station returns: rate limit [m/s],
  /// below the 2 cm/s that a map tolerates. The part beyond `slew_bound_m` [m] enters at once: minutes of a
  /// wrong height are worse than a step.
  double slew_rate_m_s = 0.012;
  double slew_bound_m = 3.0;

  /// Gate of the pressure's innovation in standard deviations.
  double gate_sigma = 4.0;
  /// Longest gating [s], after which the pressure is used again: doors last 1 to 2 s.
  double gate_time_s = 3.0;

  /// Timeout of the barometer [s] (at least three of its own intervals), after which the height is held.
  /// Short enough to report the loss within half a second.
  double barometer_timeout_s = 0.4;

  /// Detection of moving ground (elevator): the vertical speed from acceleration differs from the wheels' by
  /// more than this [m/s] and by more than `moving_ground_sigma` standard deviations.
  double moving_ground_speed_m_s = 0.12;
  double moving_ground_sigma = 5.0;
  /// End of moving ground: both agree within this [m/s] for this long [s].
  double ground_stopped_speed_m_s = 0.04;
  double ground_stopped_time_s = 1.2;
};

/// Limits of valid input.
struct PriorLimits {
  /// Largest angular rate [rad/s] and specific force [m/s^2] per axis: ranges of the sensors (2000 deg/s, 16
  /// g).
  double max_gyro_rad_s = 35.0;
  double max_accel_m_s2 = 160.0;
  /// A longer step of IMU time is a gap [s]: bridged, counted, variance added.
  double imu_gap_s = 0.1;
  /// A longer step, forwards or backwards, is a jump of the clock [s]: it needs a second, agreeing sample,
  /// and the attitude starts anew.
  double imu_restart_s = 10.0;
  /// Samples of barometer, base station and wheels further ahead of the IMU than this are refused [s].
  double max_ahead_s = 5.0;
};

struct PriorConfig {
  /// False: no IMU; priors come from PriorEstimator::advance(), from wheels and barometers.
  bool has_imu = true;
  /// Pose of the IMU in base_link.
  Eigen::Isometry3d T_base_imu = Eigen::Isometry3d::Identity();
  /// Position of the barometer's pressure port in base_link [m].
  Eigen::Vector3d p_base_port = Eigen::Vector3d::Zero();

  /// Calibrations of the robot's barometer and of the first base station's; the latter is empty where the
  /// station compensates its own samples.
  CompensationConfig compensation;
  CompensationConfig base_compensation;

  AltimeterConfig altimeter;
  AttitudeConfig attitude;
  StandstillConfig standstill;
  DeadReckoningConfig dead_reckoning;
  HeightConfig height;
  PriorLimits limits;
};

}  // namespace isobar
