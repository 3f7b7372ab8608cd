// SPDX-License-Identifier: BSD-3-Clause
// Conversion between ROS 2 messages and samples. Received values are checked here, before their first use.
#pragma once

#include <cstdint>
#include <string>

#include "core/samples.hpp"
#include "ipc/dds/topics.hpp"

namespace isobar::dds {

/// Each to_sample() returns nullptr and fills the sample, with its stamp on the sender's clock; or it returns
/// the rule that the message breaks and leaves the sample unchanged.

/// FluidPressure [Pa]. The temperature, not part of the message, becomes NaN; so does a variance that is not
/// positive, which means unknown.
[[nodiscard]] const char* to_sample(const PressureMessage& message, PressureSample& sample) noexcept;

/// Imu, in the sensor's frame. orientation_covariance[0] = -1: the message has no orientation (REP-145).
[[nodiscard]] const char* to_sample(const ImuMessage& message, ImuSample& sample) noexcept;

/// Twist of an Odometry message with the variances of x, y and yaw where it states them; its pose is ignored.
[[nodiscard]] const char* to_sample(const OdometryMessage& message, WheelSample& sample) noexcept;

/// Twist of base_link in base_link, likewise.
[[nodiscard]] const char* to_sample(const TwistMessage& message, WheelSample& sample) noexcept;

/// Temperature of a base station's barometer.
struct TemperatureSample {
  std::int64_t stamp_ns = 0;  ///< sender's clock
  double temperature_c = 0.0;
};
[[nodiscard]] const char* to_sample(const TemperatureMessage& message, TemperatureSample& sample) noexcept;

/// Messages of a base station's own barometer. A variance of NaN is sent as 0, unknown.
void fill_pressure(const PressureSample& sample, const std::string& frame, PressureMessage& message) noexcept;
void fill_temperature(const PressureSample& sample, const std::string& frame,
                      TemperatureMessage& message) noexcept;

}  // namespace isobar::dds
