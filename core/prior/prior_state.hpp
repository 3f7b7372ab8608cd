// SPDX-License-Identifier: BSD-3-Clause
// State of the prior stage. Internal to the four files that implement PriorEstimator:
//
//     prior_estimator.cpp   samples in: checked, counted, handed to the parts below
//     prior_motion.cpp      one IMU sample: alignment at first, then one step of all filters
//     prior_without_imu.cpp one step of wheels and height, of a robot without an IMU
//     prior_output.cpp      Prior and BarometerHealth out
//
//     ImuSample ──▶ ImuGate ──▶ GravityAlignment ──▶ AttitudeFilter ◀── StandstillDetector, DeviceAttitude
//                                (first 0.5 s)          ▲    │ attitude, rate
//     WheelSample ──▶ WheelOdometer ────────────────────┘    ▼
//                          ├── displacement ───────────▶ p_odom_base ──▶ Prior::T_odom_base
//                          └── ClimbMeter ─────────────▶ HeightFilter ──▶ Prior::height_m
//     PressureSample ──▶ SensorCompensation ──▶ DifferentialAltimeter ──▲
#pragma once

#include <limits>

#include "core/altitude/drift_watch.hpp"
#include "core/prior/air_ride.hpp"
#include "core/prior/attitude_filter.hpp"
#include "core/prior/climb_meter.hpp"
#include "core/prior/dead_reckoning.hpp"
#include "core/prior/device_attitude.hpp"
#include "core/prior/gravity_alignment.hpp"
#include "core/prior/height_filter.hpp"
#include "core/prior/imu_gate.hpp"
#include "core/prior/imu_noise.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/prior/rest_gravity.hpp"
#include "core/prior/slip_watch.hpp"
#include "core/prior/standstill.hpp"
#include "core/stamp.hpp"

namespace isobar {

struct PriorEstimator::State {
  explicit State(const PriorConfig& c)
      : config(c),
        R_base_imu(c.T_base_imu.linear()),
        p_base_imu(c.T_base_imu.translation()),
        imu_gate(c.limits),
        alignment(c.attitude.start_time_s),
        attitude(c.attitude, p_base_imu),
        device(Eigen::Quaterniond(R_base_imu), c.attitude.use_imu_attitude),
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
  Eigen::Vector3d p_base_imu;

  ImuGate imu_gate;
  ImuNoise noise;
  GravityAlignment alignment;
  AttitudeFilter attitude;
  DeviceAttitude device;
  StandstillDetector standstill;
  RestGravity rest_gravity;
  WheelOdometer wheels;
  SlipWatch slip;
  ClimbMeter climb;
  SensorCompensation compensation;
  SensorCompensation base_compensation;
  DifferentialAltimeter altimeter;
  HeightFilter height;
  AirRide air_ride;  // without an IMU
  DriftWatch drift;  // of the altimeter, while the robot stands

  Eigen::Vector3d p_odom_base = Eigen::Vector3d::Zero();
  double yaw_before_rad = 0.0;                            // yaw of a restart after a clock jump
  Eigen::Vector3d gyro_before = Eigen::Vector3d::Zero();  // of the sample before, base axes [rad/s]
  bool new_wheels = false;                                // since the last IMU sample
  double since_bounded_s = 0.0;                           // since the last bounded-velocity update
  HeightSource reading_source = HeightSource::kNone;      // of the last altimeter reading
  double reading_m = 0.0;                                 // of the last altimeter reading
  double climbed_m = 0.0;                                 // integral of the height filter's vertical speed
  double altimeter_m = 0.0;                               // last reading, of base_link
  double altimeter_variance_m2 = 0.0;
  double base_air_m = 0.0;  // the base station's part of it
  std::uint32_t altimeter_count = 0;
  double altimeter_shift_m = 0.0;  // sum of the steps that base stations made
  double up_accel_m_s2 = 0.0;      // of the last IMU sample, biases included
  std::int64_t height_start_ns = 0;
  HeightDatum resumed;           // of an earlier run; !known: none
  std::int64_t aligned_ns = 0;   // first alignment; 0: not yet
  std::int64_t advanced_ns = 0;  // without an IMU: time of the estimate
  double plane_yaw_rad = 0.0;    // without an IMU: yaw by the wheels
  double wheel_turn_rad = 0.0;   // without an IMU: WheelOdometer::turn_rad() already in it

  // prior_motion.cpp. `gyro` [rad/s] and `force` [m/s^2] in base axes.
  void align(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s);
  void start_height();
  [[nodiscard]] double wait_for_pressure_s(std::int64_t start_ns) const;
  void continue_height(double vz_sigma_m_s);
  void keep_climbing(double pause_s, VerticalFilter::Continuation& from) const;
  [[nodiscard]] bool wheels_stand() const;
  static void use_unseen_climb(double risen_m, VerticalFilter::Continuation& from);
  void step(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s, bool gap);
  void bridge_gap(const Eigen::Vector3d& gyro, double dt_s);
  void restart_clock(double dt_s);
  void use_device_attitude(const ImuSample& sample, const Eigen::Vector3d& gyro, double dt_s);
  void use_standstill(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s, bool on_wheels);
  void use_rest(bool on_wheels);
  void use_wheels(std::int64_t stamp_ns, double dt_s, bool on_wheels);
  void watch_slip(double dt_s, bool comparable);
  void use_climb(double dt_s, bool on_wheels, bool pressure_lost);

  // prior_without_imu.cpp
  void set_clock_back();
  void roll_on_plane(std::int64_t stamp_ns);
  [[nodiscard]] Prior prior_of_wheels() const;

  // prior_output.cpp
  [[nodiscard]] Prior prior_at(const ImuSample& sample) const;
  void fill_attitude(const ImuSample& sample, Prior& out) const;
  void fill_wheels(std::int64_t stamp_ns, Prior& out) const;
  void fill_altimeter(Prior& out) const;
  void fill_height(std::int64_t stamp_ns, Prior& out) const;
  void watch_barometers();
  void watch_drift();
  [[nodiscard]] BarometerFault robot_fault() const;
  [[nodiscard]] BarometerFault base_fault(std::size_t station) const;
  [[nodiscard]] bool disturbed_for(double seconds) const;
  [[nodiscard]] HeightSource source(std::int64_t stamp_ns) const;

  /// True for stamps that are implausible or too far ahead of the IMU.
  [[nodiscard]] bool bad_stamp(std::int64_t stamp_ns) const {
    if (!plausible_stamp(stamp_ns)) return true;
    return started() && seconds_between(now_ns(), stamp_ns) > config.limits.max_ahead_s;
  }
  /// Time of the estimate: of the last IMU sample; without an IMU, of the last advance(). 0: none yet.
  [[nodiscard]] std::int64_t now_ns() const { return config.has_imu ? imu_gate.stamp_ns() : advanced_ns; }
  [[nodiscard]] bool started() const { return config.has_imu ? imu_gate.started() : advanced_ns != 0; }
  /// Levers have an attitude: gravity's, or that of a level robot where there is no IMU to tell.
  [[nodiscard]] bool levelled() const { return attitude.started() || !config.has_imu; }
  /// Height of the pressure port by dead reckoning [m], to compare base stations with; NaN where unknown.
  [[nodiscard]] double witness_m() const {
    const bool known = attitude.started() && wheels.valid(now_ns()) && !height.ground_moves();
    return known ? p_odom_base.z() + above_base(config.p_base_port)
                 : std::numeric_limits<double>::quiet_NaN();
  }
  /// Vertical component of a vector in base axes: height of a point of base_link above its origin.
  [[nodiscard]] double above_base(const Eigen::Vector3d& p_base) const {
    return (attitude.q_world_base() * p_base).z();
  }
};

}  // namespace isobar
