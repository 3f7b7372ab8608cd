// SPDX-License-Identifier: BSD-3-Clause
// What the prior stage carries from sample to sample. Internal to the files that implement PriorEstimator.
#pragma once

#include <limits>

#include "core/prior/attitude_filter.hpp"
#include "core/prior/dead_reckoning.hpp"
#include "core/prior/height_filter.hpp"
#include "core/prior/imu_gate.hpp"
#include "core/prior/imu_noise.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/prior/standstill.hpp"
#include "core/stamp.hpp"

namespace isobar {

struct PriorEstimator::State {
  explicit State(const PriorConfig& c)
      : config(c),
        R_base_imu(c.T_base_imu.linear()),
        q_base_imu(R_base_imu),
        p_base_imu(c.T_base_imu.translation()),
        imu_gate(c.limits),
        attitude(c.attitude, p_base_imu),
        standstill(c.standstill),
        wheels(c.dead_reckoning),
        compensation(c.compensation),
        base_compensation(c.base_compensation),
        altimeter(c.altimeter),
        height(c.height) {}

  PriorConfig config;
  PriorCounters counters;
  BarometerHealth barometers;
  Eigen::Matrix3d R_base_imu;
  Eigen::Quaterniond q_base_imu;
  Eigen::Vector3d p_base_imu;

  ImuGate imu_gate;
  ImuNoise noise;
  AttitudeFilter attitude;
  StandstillDetector standstill;
  WheelOdometer wheels;
  SensorCompensation compensation;
  SensorCompensation base_compensation;
  DifferentialAltimeter altimeter;
  HeightFilter height;

  // Start of the attitude: specific force summed in the axes of the newest sample.
  Eigen::Vector3d start_force_sum = Eigen::Vector3d::Zero();
  double start_elapsed_s = 0.0;
  int start_samples = 0;
  double yaw_before_rad = 0.0;

  Eigen::Vector3d gyro_before = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_device_before = Eigen::Quaterniond::Identity();
  bool has_device_before = false;
  double since_device_s = 0.0;
  Eigen::Vector3d device_bias_sum = Eigen::Vector3d::Zero();

  Eigen::Vector3d p_odom_base = Eigen::Vector3d::Zero();
  bool new_wheels = false;
  double since_bounded_s = 0.0;
  double since_climb_s = 0.0;
  double climb_integral_m = 0.0;
  double forward_integral_m = 0.0;

  HeightSource reading_source = HeightSource::kNone;
  std::int64_t height_start_ns = 0;

  void align(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s);
  void restart_alignment();
  void bridge_gap(const Eigen::Vector3d& gyro, double dt_s);
  void restart_clock(double dt_s);
  void move(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s, bool gap);
  void use_device_attitude(const ImuSample& sample, const Eigen::Vector3d& gyro, double dt_s);
  void use_standstill(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s, bool on_wheels);
  void use_wheels(std::int64_t stamp_ns, double dt_s, bool on_wheels);
  void use_climb(double dt_s, bool on_wheels, bool pressure_lost);
  void fill(const ImuSample& sample, Prior& out) const;
  void watch_barometers();
  [[nodiscard]] BarometerFault robot_fault() const;
  [[nodiscard]] bool disturbed_for(double seconds) const;
  [[nodiscard]] HeightSource source(std::int64_t stamp_ns) const;
  [[nodiscard]] bool bad_stamp(std::int64_t stamp_ns) const {
    if (!plausible_stamp(stamp_ns)) return true;
    return imu_gate.started() && seconds_between(imu_gate.stamp_ns(), stamp_ns) > config.limits.max_ahead_s;
  }
  /// Height of the pressure port as the wheels have it [m]; NaN where they cannot have it.
  [[nodiscard]] double witness_m() const {
    const bool known = attitude.started() && wheels.valid(imu_gate.stamp_ns()) && !height.ground_moves();
    return known ? p_odom_base.z() + above_base(config.p_base_port)
                 : std::numeric_limits<double>::quiet_NaN();
  }
  /// Height of a point of base_link above base_link's origin.
  [[nodiscard]] double above_base(const Eigen::Vector3d& p_base) const {
    return (attitude.q_world_base() * p_base).z();
  }
};

}  // namespace isobar
