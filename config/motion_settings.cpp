// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"
#include "core/plausibility.hpp"

namespace isobar {
namespace {

void add_inertial_noise(AttitudeConfig& attitude, SectionBuilder& s) {
  s.number("start_time_s", &attitude.start_time_s, "s", 0.1, 10.0,
           "Averaging time of the specific force from which roll and pitch start. 0.5: vibration of 1 m/s^2 "
           "rms at 200 Hz leaves 0.6 deg, which the filter then removes.");
  s.number("gyro_bias_sigma_rad_s", &attitude.gyro_bias_sigma_rad_s, "rad/s", 0.0, 0.5,
           "Turn-on bias of each gyro axis, 1 sigma. 0.0087 is 0.5 deg/s: a consumer to industrial MEMS.");
  s.number("gyro_bias_walk_rad_s_sqrt_s", &attitude.gyro_bias_walk_rad_s_sqrt_s, "rad/s/sqrt(s)", 0.0, 0.01,
           "Random walk of the gyro bias. 0.000003: 10 deg/h of in-run stability over some minutes.");
  s.number("gyro_noise_rad_sqrt_s", &attitude.gyro_noise_rad_sqrt_s, "rad/sqrt(s)", 1e-6, 0.1,
           "Lower bound of the angle random walk, which is raised online for a noisier gyro. 0.00026 is "
           "0.015 deg/s/sqrt(Hz), between a VN-100 (0.0035) and an MTi-10 (0.03).");
  s.number("accel_bias_sigma_m_s2", &attitude.accel_bias_sigma_m_s2, "m/s^2", 0.0, 1.0,
           "Bias of each accelerometer axis, 1 sigma. 0.03 is 3 mg, or 0.18 deg of roll or pitch.");
  s.number("accel_bias_walk_m_s2_sqrt_s", &attitude.accel_bias_walk_m_s2_sqrt_s, "m/s^2/sqrt(s)", 0.0, 0.1,
           "Random walk of the accelerometer bias. 0.00002 is 0.12 mg in an hour: nearly constant.");
  s.number("accel_noise_m_s_sqrt_s", &attitude.accel_noise_m_s_sqrt_s, "m/s/sqrt(s)", 1e-5, 1.0,
           "Lower bound of the velocity random walk, which vibration raises online. 0.003 is 0.3 "
           "mg/sqrt(Hz).");
}

void add_wheel_noise(AttitudeConfig& attitude, SectionBuilder& s) {
  s.number("wheel_sigma_m_s", &attitude.wheel_sigma_m_s, "m/s", 1e-3, 1.0,
           "Constant part of the wheel speed's error, 1 sigma. 0.03: it outweighs wheel_sigma_share below "
           "0.6 m/s.");
  s.number("wheel_sigma_share", &attitude.wheel_sigma_share, "", 1e-3, 1.0,
           "Error of the wheel speed as a share of it, 1 sigma. 0.05: tracks slip by per cents.");
  s.number("wheel_correlation_s", &attitude.wheel_correlation_s, "s", 0.01, 10.0,
           "Correlation time of the wheel speed's error: slip lasts. Samples at a higher rate then add no "
           "information.");
  s.number("lateral_sigma_m_s", &attitude.lateral_sigma_m_s, "m/s", 1e-3, 1.0,
           "Sideways slip of base_link, 1 sigma: the non-holonomic constraint. 0.05: wheels hardly slide "
           "sideways.");
  s.number("vertical_sigma_m_s", &attitude.vertical_sigma_m_s, "m/s", 1e-3, 1.0,
           "Speed of base_link across its own floor, 1 sigma: the non-holonomic constraint. 0.1: uneven "
           "floors and suspension move it more than sideways slip.");
}

void add_no_wheels(AttitudeConfig& attitude, SectionBuilder& s) {
  s.number("free_velocity_sigma_m_s", &attitude.free_velocity_sigma_m_s, "m/s", 0.05, 20.0,
           "Rms of the velocity without wheels. 0.5: a pendulum of 0.5 m amplitude on 10 to 30 m of rope "
           "swings with 0.3 to 0.5.");
  s.number("free_velocity_correlation_s", &attitude.free_velocity_correlation_s, "s", 0.1, 60.0,
           "Correlation time of the velocity without wheels. 3: half the period of a pendulum on 10 m of "
           "rope.");
}

void add_imu_attitude(AttitudeConfig& attitude, SectionBuilder& s) {
  s.flag(
      "use_imu_attitude", attitude.use_imu_attitude,
      "Use the IMU's own attitude: roll and pitch as measurements, and its rotation instead of the gyro's. "
      "false: how a device's filter behaves in an elevator or on stairs is not documented.");
  s.number("imu_attitude_sigma_rad", &attitude.imu_attitude_sigma_rad, "rad", 1e-4, 0.5,
           "Error of the IMU's own roll and pitch, 1 sigma; used with use_imu_attitude. 0.007 is 0.4 deg.");
  s.number("imu_attitude_correlation_s", &attitude.imu_attitude_correlation_s, "s", 0.01, 60.0,
           "Correlation time of the error of the IMU's own attitude; used with use_imu_attitude. Samples "
           "within it add no information.");
}

void add_attitude(AttitudeConfig& attitude, std::vector<Setting>& settings) {
  SectionBuilder s("attitude", UsedBy::kRobot, settings);
  add_inertial_noise(attitude, s);
  add_wheel_noise(attitude, s);
  add_no_wheels(attitude, s);
  add_imu_attitude(attitude, s);
}

void add_standstill(StandstillConfig& standstill, std::vector<Setting>& settings) {
  SectionBuilder s("standstill", UsedBy::kRobot, settings);
  s.applies(Apply::kLive);
  s.number("window_s", &standstill.window_s, "s", 0.1, 5.0,
           "Time that gyro, accelerometer and wheels must all be quiet. 0.6: long enough for a mean of 120 "
           "samples at 200 Hz, short enough for brief stops.");
  s.number("max_gyro_rms_rad_s", &standstill.max_gyro_rms_rad_s, "rad/s", 1e-4, 1.0,
           "Largest rms of the angular rate about its mean, each axis. 0.02 is 1.1 deg/s; the gyro decides, "
           "the accelerometer only supports it.");
  s.number("max_accel_rms_m_s2", &standstill.max_accel_rms_m_s2, "m/s^2", 1e-3, 10.0,
           "Largest rms of the specific force about its mean. 1.5: fans and a running engine (1 m/s^2) may "
           "shake a robot that stands.");
  s.number("max_rate_rad_s", &standstill.max_rate_rad_s, "rad/s", 1e-4, 1.0,
           "Largest mean angular rate, known bias subtracted. 0.02 is 1.1 deg/s: a robot that turns is "
           "faster.");
  s.number("max_wheel_speed_m_s", &standstill.max_wheel_speed_m_s, "m/s", 0.0, 1.0,
           "Largest wheel speed that counts as zero. 0.005: above encoder noise, below any motion.");
  s.number("max_wheel_rate_rad_s", &standstill.max_wheel_rate_rad_s, "rad/s", 0.0, 1.0,
           "Largest turn rate of the wheels that counts as zero. 0.01 is 0.6 deg/s: above encoder noise, "
           "below any motion.");
}

void add_dead_reckoning(DeadReckoningConfig& dead_reckoning, std::vector<Setting>& settings) {
  SectionBuilder s("dead_reckoning", UsedBy::kRobot, settings);
  s.applies(Apply::kLive);
  s.number("wheel_timeout_s", &dead_reckoning.wheel_timeout_s, "s", 0.05, 10.0,
           "Silence after which the wheels are lost. 0.5: five scans at 10 Hz.");
  s.number("max_speed_m_s", &dead_reckoning.max_speed_m_s, "m/s", 0.1, kPlausibleWheelMS.highest,
           "Top wheel speed of the robot; a larger one is a fault of encoder or link. 10 is 36 km/h.");
  s.number("max_turn_rate_rad_s", &dead_reckoning.max_turn_rate_rad_s, "rad/s", 0.1,
           kPlausibleWheelRadS.highest,
           "Top turn rate of the robot; a larger one is a fault of encoder or link. 15 is 2.4 "
           "turns a second.");
  s.number("max_acceleration_m_s2", &dead_reckoning.max_acceleration_m_s2, "m/s^2", 1.0, 1e3,
           "Largest plausible acceleration between two wheel samples; a larger one is a fault of encoder or "
           "link. 30 is 3 g.");
}

void add_limits(PriorLimits& limits, std::vector<Setting>& settings) {
  SectionBuilder s("limits", UsedBy::kRobot, settings);
  s.applies(Apply::kLive);
  s.number("max_gyro_rad_s", &limits.max_gyro_rad_s, "rad/s", 0.1, kPlausibleGyroRadS.highest,
           "Largest angular rate of an axis. 35 is a gyro's usual range of 2000 deg/s.");
  s.number("max_accel_m_s2", &limits.max_accel_m_s2, "m/s^2", 20.0, kPlausibleAccelMS2.highest,
           "Largest specific force of an axis. 160 is an accelerometer's usual range of 16 g.");
  s.number("imu_gap_s", &limits.imu_gap_s, "s", 0.005, 10.0,
           "Smallest step of IMU time that is a gap: bridged, counted, and added to the uncertainty. 0.1: 20 "
           "samples at 200 Hz.");
  s.number(
      "imu_restart_s", &limits.imu_restart_s, "s", 0.1, 600.0,
      "Smallest step of IMU time, forwards or backwards, that a second sample must confirm; the attitude "
      "then starts anew. 10: longer than dead reckoning can bridge.");
  s.number("max_ahead_s", &limits.max_ahead_s, "s", 0.1, 600.0,
           "Largest lead of the other sensors' time stamps over the IMU's; samples beyond are refused. 5: a "
           "wrong clock, not a delay.");
}

}  // namespace

void add_motion_settings(PriorConfig& prior, std::vector<Setting>& settings) {
  add_attitude(prior.attitude, settings);
  add_standstill(prior.standstill, settings);
  add_dead_reckoning(prior.dead_reckoning, settings);
  add_limits(prior.limits, settings);
}

}  // namespace isobar
