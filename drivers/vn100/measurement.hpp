// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/device/device.hpp"

namespace isobar::vn100 {

/// What a message holds of use here.
struct Measurement {
  bool has_time = false;
  std::int64_t time_startup_ns = 0;          ///< since the sensor's start
  bool has_accel = false, has_gyro = false;  ///< only both make a reading's has_imu
  InertialReading reading;                   ///< without stamps
};

/// Specific force and angular rate of a message, each where it has one.
struct Inertial {
  std::optional<Eigen::Vector3d> accel_m_s2, gyro_rad_s;
  void put_into(Measurement& result) const noexcept;
};

/// Reads a whole packet. The values stay in the sensor's own frame: x forward, y right, z down as its housing
/// shows it, so that accel reads (0, 0, -g) at rest with the label up, and imu.rpy_deg is [180, 0, 0] there.
///
/// Rates and accelerations: those before the sensor's own filter takes its bias estimates out, since the
/// estimator estimates the biases itself; else the compensated ones; else increments divided by their time. Accelerations
/// from which the sensor has taken gravity ("linear") are none.
/// An attitude is given in a world with z up: the sensor's north-east-down, turned by 180 degrees about north.
[[nodiscard]] Measurement read_packet(std::span<const std::uint8_t> packet) noexcept;

/// Attitude in a world of north, west, up.
/// @param q_ned_imu of the sensor, scalar last in its messages
[[nodiscard]] Eigen::Quaterniond to_world_z_up(const Eigen::Quaterniond& q_ned_imu) noexcept;
/// @param ypr_deg yaw, pitch, roll of the sensor in north, east, down, turned in this order
[[nodiscard]] Eigen::Quaterniond from_yaw_pitch_roll(const Eigen::Vector3d& ypr_deg) noexcept;

/// Puts in the attitude, turned into a world with z up; none when the norm is not about 1.
/// @param q_ned_imu of the sensor
void set_attitude(const Eigen::Quaterniond& q_ned_imu, ImuSample& imu) noexcept;
/// Puts in a pressure. @param temperature_c NaN: none
void set_pressure(double pressure_kpa, double temperature_c, InertialReading& reading) noexcept;

}  // namespace isobar::vn100
