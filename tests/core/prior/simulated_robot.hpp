// SPDX-License-Identifier: BSD-3-Clause
// Simulated robot for tests of the prior: exact motion in closed form, sensors with errors of realistic size.
// Independent of the estimator.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "core/prior/prior_config.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/samples.hpp"

namespace isobar::test {

struct Pose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// Pose of base_link in the world as a smooth function of time [s].
using Motion = std::function<Pose(double)>;

/// Distance travelled at time t [m]: speed v from t0 to t1, with smooth ramps of duration ramp_s after t0 and
/// after t1.
inline double travelled(double t, double v, double t0, double t1, double ramp_s) {
  const auto integral = [](double u) {  // of the quintic smoothstep 6u^5-15u^4+10u^3
    if (u <= 0.0) return 0.0;
    if (u >= 1.0) return u - 0.5;
    return u * u * u * u * (2.5 + u * (-3.0 + u));
  };
  return v * ramp_s * (integral((t - t0) / ramp_s) - integral((t - t1) / ramp_s));
}

/// Drives on a helix: radius (signed, left positive), height and its slope as functions of the horizontal
/// distance s.
struct Drive {
  double speed = 0.6;
  double start_s = 3.0;
  double stop_s = 1e9;
  double ramp_s = 1.0;
  double radius_m = 1e6;
  std::function<double(double)> height = [](double) { return 0.0; };
  std::function<double(double)> lift = [](double) { return 0.0; };  ///< elevator's height [m] by time

  Pose operator()(double t) const {
    const double s = travelled(t, speed, start_s, stop_s, ramp_s);
    const double yaw = s / radius_m;
    const double slope = (height(s + 1e-3) - height(s - 1e-3)) / 2e-3;
    Pose pose;
    pose.p = {radius_m * std::sin(yaw), radius_m * (1.0 - std::cos(yaw)), height(s) + lift(t)};
    pose.q = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
             Eigen::AngleAxisd(-std::atan(slope), Eigen::Vector3d::UnitY());
    return pose;
  }
};

/// Sizes of the errors. Zero is a perfect sensor.
struct SensorErrors {
  double gyro_noise = 0.0005 * std::sqrt(100.0);  ///< rad/s a sample: MTi-10, 0.03 deg/s/sqrt(Hz) over 100 Hz
  double accel_noise = 0.006;                     ///< m/s^2 a sample: 60 ug/sqrt(Hz) over 100 Hz
  double gyro_bias = 0.005;                       ///< rad/s, 1 sigma an axis
  double accel_bias = 0.02;                       ///< m/s^2, 1 sigma an axis
  double vibration = 0.5;                         ///< m/s^2 rms while the wheels turn
  double misalignment = 0.003;                    ///< rad, 1 sigma of roll and pitch of the IMU's mount
  double wheel_scale = 0.02;                      ///< relative, 1 sigma
  double wheel_noise = 0.01;                      ///< m/s a sample
  double stairs_slip = 0.05;                      ///< share of the speed lost at pitch above 10 deg
  double pressure_noise = 0.35;                   ///< Pa a sample
  double turbulence = 0.15;                       ///< Pa rms, each sensor on its own
  double turbulence_time_s = 10.0;
  double warm_up = 1.0;  ///< Pa, drift of one sensor, time constant 300 s
  double weather_pa_s = 0.03;
  double self_heating_k = 4.0;
};

struct SimulatedRobot {
  Motion motion;
  double duration_s = 60.0;
  double imu_hz = 200.0;
  double wheel_hz = 50.0;  ///< 0: no wheels
  double robot_hz = 32.0;  ///< 0: no barometer
  double base_hz = 32.0;   ///< 0: no base station
  double base_delay_s = 0.0;
  double air_k = 293.15;
  SensorErrors errors;
  Eigen::Isometry3d T_base_imu = Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.02, 0.2));
  Eigen::Vector3d p_base_port{-0.2, 0.05, 0.3};
  std::function<double(double)> extra_robot_pa = [](double) { return 0.0; };  ///< doors, ventilation zones
  std::function<double(double)> common_pa = [](double) { return 0.0; };       ///< at robot and base station
  std::function<bool(double)> base_on = [](double) { return true; };
  std::function<bool(double)> robot_on = [](double) { return true; };
  std::function<bool(double)> imu_on = [](double) { return true; };
  std::function<bool(double)> wheels_on = [](double) { return true; };
};

/// Estimate and truth at one IMU sample.
struct Comparison {
  double t = 0.0;
  Pose truth;
  Prior prior;
  double height_truth_m = 0.0;  ///< above the start
  double roll_error_rad = 0.0;
  double pitch_error_rad = 0.0;
};

inline double roll_of(const Eigen::Matrix3d& R) { return std::atan2(R(2, 1), R(2, 2)); }
inline double pitch_of(const Eigen::Matrix3d& R) { return std::asin(-R(2, 0)); }

inline PriorConfig config_for(const SimulatedRobot& robot) {
  PriorConfig config;
  config.T_base_imu = robot.T_base_imu;
  config.p_base_port = robot.p_base_port;
  return config;
}

/// Runs the estimator on the robot's samples, in time order; keeps every `every`-th comparison.
std::vector<Comparison> run(const SimulatedRobot& robot, const PriorConfig& config, unsigned seed,
                            PriorCounters* counters = nullptr, int every = 1);

struct Figures {
  double roll_pitch_rms_rad = 0.0;
  double height_max_m = 0.0;
  double height_rms_m = 0.0;
  double height_final_m = 0.0;
  double z_rpe_median = 0.0;  ///< as a share of 5 m of travel
  double nees = 0.0;          ///< mean squared height error over its variance
};

Figures figures_of(const std::vector<Comparison>& comparisons, double from_s = 5.0);

}  // namespace isobar::test
