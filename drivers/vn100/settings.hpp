// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "drivers/device/device.hpp"

namespace isobar::vn100 {

/// Where a VN-100 is and what it is told to send.
struct Settings {
  std::string port = "/dev/ttyUSB0";
  int baud = 115'200;     ///< that the sensor has; its factory setting
  int rate_hz = 200;      ///< a divisor of kSensorRateHz
  bool configure = true;  ///< false: takes what the sensor sends
  int sensor_port = 1;    ///< the sensor's own serial port that is wired: 1 RS-232, 2 TTL
  bool attitude = false;  ///< asks for the attitude of the sensor's own filter, too
};

/// Rate of the sensor's own measurements, which the output divides [Hz] (factory setting of ImuRate).
inline constexpr int kSensorRateHz = 800;

/// Bytes of a packet of the output that is set up.
[[nodiscard]] int packet_bytes(const Settings& settings) noexcept;

/// The rule that the settings break, nullptr: none. Packets must fill at most 0.9 of the line.
[[nodiscard]] const char* broken_rule(const Settings& settings) noexcept;

/// @param settings validated: broken_rule() is nullptr
[[nodiscard]] std::unique_ptr<Device<InertialReading>> make_sensor(const Settings& settings);

}  // namespace isobar::vn100
