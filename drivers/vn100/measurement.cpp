// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/measurement.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/plausibility.hpp"
#include "drivers/vn100/binary_packet.hpp"

namespace isobar::vn100 {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kPascalsPerKilopascal = 1e3;

std::uint64_t integer_at(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{bytes[at + i]} << 8 * i;
  return value;
}

double float_at(Bytes bytes, std::size_t at) {
  return double{std::bit_cast<float>(static_cast<std::uint32_t>(integer_at(bytes, at, 4)))};
}

Eigen::Vector3d vector_at(Bytes bytes, std::size_t at) {
  return {float_at(bytes, at), float_at(bytes, at + 4), float_at(bytes, at + 8)};
}

/// The first of two fields that the packet has.
Bytes either(Bytes packet, Group group, int bit, Group other_group, int other_bit) {
  const Bytes bytes = field(packet, group, bit);
  return bytes.empty() ? field(packet, other_group, other_bit) : bytes;
}

/// Increments over an interval [s] to what the other fields did not give: degrees to rad/s, m/s to m/s^2.
struct Increments {
  double interval_s = 0.0;
  Bytes turn_deg, velocity_m_s;
};

Increments increments_of(Bytes packet) {
  if (const Bytes both = field(packet, Group::kCommon, 11); !both.empty()) {
    return {float_at(both, 0), both.subspan(4, 12), both.subspan(16, 12)};
  }
  const Bytes turn = field(packet, Group::kImu, 6);
  if (turn.empty()) return {};  // the interval stands with the turn
  return {float_at(turn, 0), turn.subspan(4, 12), field(packet, Group::kImu, 7)};
}

Inertial inertial_of(Bytes packet) {
  Inertial inertial;
  if (const Bytes both = field(packet, Group::kCommon, 9); !both.empty()) {
    inertial = {vector_at(both, 0), vector_at(both, 12)};
    return inertial;
  }
  Bytes accel = field(packet, Group::kImu, 2);
  Bytes gyro = field(packet, Group::kImu, 3);
  if (accel.empty()) accel = either(packet, Group::kCommon, 8, Group::kImu, 9);
  if (gyro.empty()) gyro = either(packet, Group::kCommon, 5, Group::kImu, 10);
  if (!accel.empty()) inertial.accel_m_s2 = vector_at(accel, 0);
  if (!gyro.empty()) inertial.gyro_rad_s = vector_at(gyro, 0);
  const Increments increments = increments_of(packet);
  if (!(increments.interval_s > 0.0)) return inertial;
  if (accel.empty() && !increments.velocity_m_s.empty()) {
    inertial.accel_m_s2 = vector_at(increments.velocity_m_s, 0) / increments.interval_s;
  }
  if (gyro.empty() && !increments.turn_deg.empty()) {
    inertial.gyro_rad_s = vector_at(increments.turn_deg, 0) * kRadiansPerDegree / increments.interval_s;
  }
  return inertial;
}

void read_attitude(Bytes packet, ImuSample& imu) {
  const Bytes quaternion = either(packet, Group::kCommon, 4, Group::kAttitude, 2);
  const Bytes angles = either(packet, Group::kCommon, 3, Group::kAttitude, 1);
  Eigen::Quaterniond q_ned_imu;
  if (!quaternion.empty()) {
    q_ned_imu = Eigen::Quaterniond(float_at(quaternion, 12), float_at(quaternion, 0), float_at(quaternion, 4),
                                   float_at(quaternion, 8));
  } else if (!angles.empty()) {
    q_ned_imu = from_yaw_pitch_roll(vector_at(angles, 0));
  } else {
    return;
  }
  set_attitude(q_ned_imu, imu);
}

void read_pressure(Bytes packet, InertialReading& reading) {
  Bytes pressure = field(packet, Group::kImu, 5);
  Bytes temperature = field(packet, Group::kImu, 4);
  if (const Bytes magnet = field(packet, Group::kCommon, 10); pressure.empty() && !magnet.empty()) {
    temperature = magnet.subspan(12, 4);
    pressure = magnet.subspan(16, 4);
  }
  if (pressure.empty()) return;
  set_pressure(float_at(pressure, 0),
               temperature.empty() ? std::numeric_limits<double>::quiet_NaN() : float_at(temperature, 0),
               reading);
}

}  // namespace

Eigen::Quaterniond to_world_z_up(const Eigen::Quaterniond& q_ned_imu) noexcept {
  const Eigen::Quaterniond q_world_ned(0.0, 1.0, 0.0, 0.0);  // 180 degrees about north
  return q_world_ned * q_ned_imu;
}

Eigen::Quaterniond from_yaw_pitch_roll(const Eigen::Vector3d& ypr_deg) noexcept {
  const Eigen::Vector3d angles_rad = ypr_deg * kRadiansPerDegree;
  return Eigen::AngleAxisd(angles_rad[0], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles_rad[1], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles_rad[2], Eigen::Vector3d::UnitX());
}

void set_attitude(const Eigen::Quaterniond& q_ned_imu, ImuSample& imu) noexcept {
  imu.has_attitude = kPlausibleQuaternionNorm.holds(q_ned_imu.norm());
  if (imu.has_attitude) imu.q_world_imu = to_world_z_up(q_ned_imu.normalized());
}

void set_pressure(double pressure_kpa, double temperature_c, InertialReading& reading) noexcept {
  reading.has_pressure = true;
  reading.pressure.pressure_pa = pressure_kpa * kPascalsPerKilopascal;
  reading.pressure.temperature_c =
      kPlausibleTemperatureC.holds(temperature_c) ? temperature_c : std::numeric_limits<double>::quiet_NaN();
}

void Inertial::put_into(Measurement& result) const noexcept {
  result.has_accel = accel_m_s2.has_value();
  result.has_gyro = gyro_rad_s.has_value();
  result.reading.has_imu = result.has_accel && result.has_gyro;
  if (!result.reading.has_imu) return;
  result.reading.imu.accel_m_s2 = *accel_m_s2;
  result.reading.imu.gyro_rad_s = *gyro_rad_s;
}

Measurement read_packet(Bytes packet) noexcept {
  Measurement result;
  if (const Bytes time = either(packet, Group::kCommon, 0, Group::kTime, 0); !time.empty()) {
    const std::uint64_t time_ns = integer_at(time, 0, 8);
    result.has_time = time_ns < std::uint64_t{1} << 62U;
    if (result.has_time) result.time_startup_ns = static_cast<std::int64_t>(time_ns);
  }
  inertial_of(packet).put_into(result);
  if (result.reading.has_imu) read_attitude(packet, result.reading.imu);
  read_pressure(packet, result.reading);
  return result;
}

}  // namespace isobar::vn100
