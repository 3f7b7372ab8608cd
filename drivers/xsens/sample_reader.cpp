// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/xsens/sample_reader.hpp"

#include <cmath>
#include <numbers>

#include "core/plausibility.hpp"
#include "core/so3.hpp"

namespace isobar::xsens {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
/// Longest period of increments [kTickNs]: outputs of 5 Hz.
constexpr std::uint32_t kLongestTicks = 2'000;

Eigen::Vector3d vector_of(const DataItem& item) { return {item.number(0), item.number(1), item.number(2)}; }

/// Roll, pitch, yaw [deg], turned in the order yaw, pitch, roll.
Eigen::Quaterniond from_euler(const Eigen::Vector3d& rpy_deg) {
  const Eigen::Vector3d angles_rad = rpy_deg * kRadiansPerDegree;
  return Eigen::AngleAxisd(angles_rad[2], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles_rad[1], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles_rad[0], Eigen::Vector3d::UnitX());
}

/// Sent column by column.
Eigen::Quaterniond from_matrix(const DataItem& item) {
  Eigen::Matrix3d matrix;
  for (std::size_t i = 0; i < 9; ++i) {
    matrix(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) = item.number(i);
  }
  return Eigen::Quaterniond(matrix);
}

}  // namespace

std::optional<Eigen::Quaterniond> read_attitude(const DataItem& item) noexcept {
  const std::optional<World> world = item.world();
  std::optional<Eigen::Quaterniond> q;
  if (item.is(Item::kQuaternion) && item.has_numbers(4)) {
    q = Eigen::Quaterniond(item.number(0), item.number(1), item.number(2), item.number(3));
  } else if (item.is(Item::kEulerAngles) && item.has_numbers(3)) {
    q = from_euler(vector_of(item));
  } else if (item.is(Item::kRotationMatrix) && item.has_numbers(9)) {
    q = from_matrix(item);
  }
  if (!q || !world || !kPlausibleQuaternionNorm.holds(q->norm())) return std::nullopt;
  if (*world == World::kNorthEastDown)
    q = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0) * *q;  // 180 deg about north
  return q->normalized();
}

void SampleReader::take(const DataItem& item, Inertial& inertial) noexcept {
  if (item.is(Item::kTurnIncrement) && item.has_numbers(4)) {
    const Eigen::Quaterniond turn(item.number(0), item.number(1), item.number(2), item.number(3));
    if (kPlausibleQuaternionNorm.holds(turn.norm())) inertial.turn_rad = log_so3(turn.normalized());
  }
  take_time(item, inertial);
  if (!item.has_numbers(3)) return;
  if (item.is(Item::kFreeAcceleration)) inertial.has_free_accel = true;
  if (item.is(Item::kAcceleration)) inertial.accel_m_s2 = vector_of(item);
  if (item.is(Item::kAccelerationHighRate) && !inertial.accel_m_s2) inertial.accel_m_s2 = vector_of(item);
  if (item.is(Item::kRateOfTurn)) inertial.gyro_rad_s = vector_of(item);
  if (item.is(Item::kRateOfTurnHighRate) && !inertial.gyro_rad_s) inertial.gyro_rad_s = vector_of(item);
  if (item.is(Item::kVelocityIncrement)) inertial.velocity_m_s = vector_of(item);
}

// Nanosecond (32 bits), year (16), month, day, hour, minute, second, validity (8 each).
void SampleReader::take_time(const DataItem& item, Inertial& inertial) noexcept {
  constexpr std::size_t kUtcBytes = 12;
  constexpr std::uint32_t kTicksPerSecond = 10'000;
  if (!item.is(Item::kUtcTime) || item.data.size() != kUtcBytes) return;
  const auto nanosecond = static_cast<std::uint32_t>(item.integer(4));
  const std::uint32_t second = (item.data[8] * 60U + item.data[9]) * 60U + item.data[10];
  inertial.utc_ticks = second * kTicksPerSecond + nanosecond / static_cast<std::uint32_t>(kTickNs);
}

const char* SampleReader::lacking_of(const Inertial& inertial, bool interval_known) noexcept {
  const bool increments =
      (inertial.velocity_m_s && !inertial.accel_m_s2) || (inertial.turn_rad && !inertial.gyro_rad_s);
  if (increments && !interval_known) return "a time (SampleTimeFine) for its increments";
  if (inertial.accel_m_s2) return "rate of turn";
  if (inertial.has_free_accel) return "acceleration with gravity (it has free acceleration)";
  return inertial.gyro_rad_s ? "acceleration" : "acceleration and rate of turn";
}

void SampleReader::take_other(const DataItem& item, Measurement& result) noexcept {
  if (item.is(Item::kPacketCounter) && item.data.size() == 2) {
    result.counter = static_cast<std::uint16_t>(item.integer(2));
  } else if (item.is(Item::kSampleTimeFine) && item.data.size() == 4) {
    result.time = static_cast<std::uint32_t>(item.integer(4));
  } else if (item.is(Item::kTemperature) && item.has_numbers(1)) {
    const double temperature_c = item.number(0);
    temperature_c_ = kPlausibleTemperatureC.holds(temperature_c) ? temperature_c
                                                                 : std::numeric_limits<double>::quiet_NaN();
  } else if (item.is(Item::kPressure) && item.data.size() == 4) {
    result.reading.has_pressure = true;
    result.reading.pressure.pressure_pa = static_cast<double>(item.integer(4));
  } else if (const auto q = read_attitude(item); q) {
    result.reading.imu.has_attitude = true;
    result.reading.imu.q_world_imu = *q;
  }
}

// The packet counter does not tell a lost message from one without increments (GNSS), so that the period is the
// distance that two messages in a row had.
std::optional<double> SampleReader::interval_s(std::optional<std::uint32_t> time) noexcept {
  if (!time) return std::nullopt;
  const std::uint32_t ticks = last_time_ ? *time - *last_time_ : 0;  // wraps with the clock
  last_time_ = time;
  if (ticks > 0 && ticks <= kLongestTicks && ticks == last_ticks_) period_ticks_ = ticks;
  last_ticks_ = ticks;
  if (period_ticks_ == 0) return std::nullopt;
  return 1e-9 * static_cast<double>(kTickNs) * period_ticks_;
}

Measurement SampleReader::read(std::span<const std::uint8_t> data) noexcept {
  Measurement result;
  Inertial inertial;
  while (const std::optional<DataItem> item = take_item(data)) {
    take(*item, inertial);
    take_other(*item, result);
  }
  std::optional<double> interval;
  if (inertial.velocity_m_s || inertial.turn_rad)
    interval = interval_s(result.time ? result.time : inertial.utc_ticks);
  if (!inertial.accel_m_s2 && inertial.velocity_m_s && interval) {
    inertial.accel_m_s2 = *inertial.velocity_m_s / *interval;
  }
  if (!inertial.gyro_rad_s && inertial.turn_rad && interval)
    inertial.gyro_rad_s = *inertial.turn_rad / *interval;
  if (inertial.accel_m_s2 && inertial.gyro_rad_s) {
    result.reading.has_imu = true;
    result.reading.imu.accel_m_s2 = *inertial.accel_m_s2;
    result.reading.imu.gyro_rad_s = *inertial.gyro_rad_s;
  } else {
    result.lacking = lacking_of(inertial, interval.has_value());
  }
  result.reading.pressure.temperature_c = temperature_c_;
  return result;
}

}  // namespace isobar::xsens
