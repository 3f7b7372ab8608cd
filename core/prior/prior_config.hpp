// SPDX-License-Identifier: BSD-3-Clause
// Settings of the prior stage. Every field states its unit and why it has its default; the ranges stand in
// the settings table (config/).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/sensor_compensation.hpp"

namespace isobar {

/// Attitude and velocity from gyro, accelerometer and wheels (attitude_filter.hpp).
struct AttitudeConfig {
  /// Roll and pitch start from the mean specific force over this time [s]. Long enough to average
  /// vibration (1 m/s^2 rms at 200 Hz over 0.5 s: 0.6 deg, which the filter then brings down), short enough
  /// to be ready soon.
  double start_time_s = 0.5;

  /// Turn-on bias of each gyro axis, 1 sigma [rad/s]. 0.5 deg/s is a consumer-to-industrial MEMS.
  double gyro_bias_sigma_rad_s = 0.0087;
  /// Random walk of the gyro bias [rad/s/sqrt(s)]. 10 deg/h in-run stability over some minutes.
  double gyro_bias_walk_rad_s_sqrt_s = 3e-6;
  /// Floor of the gyro's angle random walk [rad/sqrt(s)]; raised online where the gyro is seen to
  /// be noisier. 0.015 deg/s/sqrt(Hz) lies between a VN-100 (0.0035) and an MTi-10 (0.03).
  double gyro_noise_rad_sqrt_s = 2.6e-4;

  /// Bias of each accelerometer axis, 1 sigma [m/s^2], and its walk [m/s^2/sqrt(s)]. 0.03 is 3 mg,
  /// 0.18 deg of roll or pitch; turning on the spot makes it observable.
  double accel_bias_sigma_m_s2 = 0.03;
  double accel_bias_walk_m_s2_sqrt_s = 2e-5;
  /// Floor of the accelerometer's velocity random walk [m/s/sqrt(s)]; raised online by vibration.
  double accel_noise_m_s_sqrt_s = 0.003;

  /// Wheel speed: fixed error and share of the speed, 1 sigma [m/s, 1]. Tracks slip by per cents.
  double wheel_sigma_m_s = 0.03;
  double wheel_sigma_share = 0.05;
  /// Correlation time of the wheel's error (slip lasts) [s]: densities count, not sample rates.
  double wheel_correlation_s = 0.5;
  /// Sideways and vertical slip of base_link, 1 sigma [m/s] (non-holonomic constraint).
  double lateral_sigma_m_s = 0.05;
  double vertical_sigma_m_s = 0.1;

  /// Without wheels the velocity is only known to be bounded: its rms [m/s], and correlation time
  /// [s]. A pendulum of 0.5 m amplitude on 10 to 30 m of rope swings with 0.3 to 0.5 m/s.
  double free_velocity_sigma_m_s = 0.5;
  double free_velocity_correlation_s = 3.0;

  /// Use the IMU's own attitude: its roll and pitch as measurements, its rotation between samples instead of
  /// the gyro's. Off by default: what a device's filter does in an elevator or on stairs is not documented.
  bool use_imu_attitude = false;
  /// Error of the IMU's own roll and pitch, 1 sigma [rad], and its correlation time [s].
  double imu_attitude_sigma_rad = 0.007;
  double imu_attitude_correlation_s = 2.0;
};

/// When nothing moves (standstill.hpp).
struct StandstillConfig {
  /// All must be quiet for this long [s].
  double window_s = 0.6;
  /// Rms of the angular rate about its mean, each axis [rad/s], and of the specific force [m/s^2]. The gyro
  /// decides; a force of 1.5 rms lets fans and a running engine (1 m/s^2) shake a robot that stands.
  double max_gyro_rms_rad_s = 0.02;
  double max_accel_rms_m_s2 = 1.5;
  /// Mean rate, bias taken out, as far as it is known [rad/s]: a robot turns faster than this or stands.
  double max_rate_rad_s = 0.02;
  /// Wheels: speed [m/s] and turn rate [rad/s] that count as zero.
  double max_wheel_speed_m_s = 0.005;
  double max_wheel_rate_rad_s = 0.01;
};

/// Dead reckoning with wheels (dead_reckoning.hpp).
struct DeadReckoningConfig {
  /// Wheels silent for longer are lost [s].
  double wheel_timeout_s = 0.5;
  /// Fastest believable wheel speed [m/s], turn rate [rad/s], and acceleration between
  /// samples [m/s^2]: beyond are faults of the encoder or the link.
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

  /// Angle between the direction in which the wheels roll and base_link's x-y plane as the attitude sees it,
  /// 1 sigma [rad], and its walk [rad/sqrt(s)]. 0.23 deg: 0.1 of mounting and 2 to 4 mg of
  /// accelerometer bias.
  double slope_sigma_rad = 0.004;
  double slope_walk_rad_sqrt_s = 2e-5;
  /// Error of the slope that comes and goes (attitude, suspension, uneven floor) [rad], correlation
  /// [s].
  double slope_error_rad = 0.002;
  double slope_error_correlation_s = 3.0;
  /// Error of the climb speed as a share of itself (slip on stairs), and its correlation time [s].
  double slip_share = 0.1;
  double slip_correlation_s = 3.0;
  /// Vertical speed of a standing robot's ground, 1 sigma [m/s/sqrt(Hz)].
  double rest_speed_m_s_sqrt_s = 3e-4;

  /// Local slow pressure noise (turbulence, ventilation, doors), as a height: rms [m], and
  /// correlation time [s]. 0.5 Pa over 10 s: twice what two good barometers in still air differ by
  /// once their white noise is averaged, because buildings are not still.
  double turbulence_sigma_m = 0.04;
  double turbulence_time_s = 10.0;

  /// The offset between the two barometers is learnt during this long after the first pressure [s],
  /// and constant from then on. Long enough to average turbulence; short enough that a ventilation zone
  /// entered later is not taken for an error of the beginning, which would shift all heights for good.
  double offset_learning_s = 15.0;
  /// The weather where no base station takes it out: its rate, 1 sigma [m/s], and a random walk
  /// [m/sqrt(s)]. Fronts move 1 to 4 hPa in three hours, one way for hours: 0.025 Pa/s rms, 8.5 cm a
  /// pascal. The walk is that of open air, 0.05 to 0.2 Pa/sqrt(s), and of a wind of 0.3 to 1 Pa that comes
  /// and goes within a minute and that the base station no longer takes out: 0.2 Pa/sqrt(s) together. After
  /// 120 s the standard deviation is 32 cm, after ten minutes 1.4 m.
  double weather_rate_m_s = 0.0021;
  double weather_walk_m_sqrt_s = 0.018;

  /// Drift of two barometers that warm up, which nothing shows: 1 sigma [m], and time constant [s]. Only
  /// added to the reported variance; a filter that believed it would leave errors of the wheels
  /// in the height.
  double warm_up_sigma_m = 0.05;
  double warm_up_time_s = 300.0;
  /// Pressure between ventilated zones, which nothing shows either, 1 sigma [m]: 0.3 to 1 Pa. The
  /// paper's runs show 2 to 35 cm. Only added to the reported variance, over the first minute.
  double zone_sigma_m = 0.05;

  /// A base station that returns has the weather since it was lost to tell: the reported height takes it in
  /// at this speed [m/s], below the 2 cm/s that a map bears; of more than `slew_bound_m` [m], the rest at
  /// once, because minutes of a height known to be wrong are worse than a step.
  double slew_rate_m_s = 0.012;
  double slew_bound_m = 3.0;

  /// A pressure further off than this many sigmas is not used …
  double gate_sigma = 4.0;
  /// … for at most this long [s]: doors last 1 to 2 s. After that the pressure is right.
  double gate_time_s = 3.0;

  /// A barometer without a usable sample for longer (or for three of its own intervals) is lost [s]: the
  /// height is held. Soon enough to be said within half a second.
  double barometer_timeout_s = 0.4;

  /// The ground moves (elevator) when acceleration says that the vertical speed differs from the wheels' by
  /// more than this [m/s], and by `moving_ground_sigma` standard deviations; …
  double moving_ground_speed_m_s = 0.12;
  double moving_ground_sigma = 5.0;
  /// … and has stopped when both agree within this [m/s] for this long [s].
  double ground_stopped_speed_m_s = 0.04;
  double ground_stopped_time_s = 1.2;
};

/// What arrives from outside is only believed within these limits.
struct PriorLimits {
  /// Largest angular rate [rad/s] and specific force [m/s^2] per axis: ranges of the sensors (2000 deg/s, 16
  /// g).
  double max_gyro_rad_s = 35.0;
  double max_accel_m_s2 = 160.0;
  /// A step of IMU time longer than this [s] is a gap: bridged, counted, uncertainty added.
  double imu_gap_s = 0.1;
  /// A step longer than this [s], forwards or backwards, needs a second sample that agrees before it is
  /// believed; after it the attitude starts anew.
  double imu_restart_s = 10.0;
  /// Samples of barometer, base and wheels whose time is this far ahead of the IMU [s] are refused.
  double max_ahead_s = 5.0;
};

struct PriorConfig {
  /// Pose of the IMU in base_link.
  Eigen::Isometry3d T_base_imu = Eigen::Isometry3d::Identity();
  /// Position of the barometer's pressure port in base_link [m].
  Eigen::Vector3d p_base_port = Eigen::Vector3d::Zero();

  /// Calibrations of the robot's barometer and of the first base station's, where that does not compensate
  /// its samples itself.
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
