// SPDX-License-Identifier: BSD-3-Clause
// Samples out of ROS 2's messages. Whatever comes over the network is checked here before its first use.
#pragma once

#include <cstdint>
#include <string>

#include "core/samples.hpp"
#include "ipc/dds/topics.hpp"

namespace isobar::dds {

/// Each returns nullptr and fills the sample, stamp on the sender's clock, or returns the rule that the
/// message breaks and leaves the sample as it was.

/// FluidPressure [Pa]. ROS has no temperature beside it: NaN. A variance that is not positive is unknown:
/// NaN.
[[nodiscard]] const char* to_sample(const PressureMessage& message, PressureSample& sample) noexcept;

/// Imu, in the sensor's own frame. Orientation is taken where orientation_covariance[0] is not -1 (REP-145).
[[nodiscard]] const char* to_sample(const ImuMessage& message, ImuSample& sample) noexcept;

/// The twist of an Odometry; its pose is not used.
[[nodiscard]] const char* to_sample(const OdometryMessage& message, WheelSample& sample) noexcept;

/// What a thermometer said.
struct TemperatureSample {
  std::int64_t stamp_ns = 0;  ///< sender's clock
  double temperature_c = 0.0;
};
[[nodiscard]] const char* to_sample(const TemperatureMessage& message, TemperatureSample& sample) noexcept;

/// The other way: a base station's own pressure, and the temperature of its barometer.
void fill_pressure(const PressureSample& sample, const std::string& frame, PressureMessage& message) noexcept;
void fill_temperature(const PressureSample& sample, const std::string& frame,
                      TemperatureMessage& message) noexcept;

}  // namespace isobar::dds
