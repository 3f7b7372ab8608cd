// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "drivers/device/device.hpp"

namespace isobar::xsens {

/// Where an Xsens MTi is and what it is told to send.
struct Settings {
  std::string port = "/dev/ttyUSB0";
  int baud = 115'200;     ///< that the sensor has; its factory setting
  int rate_hz = 100;      ///< every MTi from the 1-series on has it
  bool configure = true;  ///< false: takes what the sensor sends
  bool pressure = true;   ///< asks for the pressure; a model without a barometer is then asked again without
  bool attitude = false;  ///< asks for the attitude of the sensor's own filter, too
};

/// Bytes of a message of the output that is set up.
[[nodiscard]] int message_bytes(const Settings& settings) noexcept;

/// The rule that the settings break, nullptr: none. Messages must fill at most 0.9 of the line.
[[nodiscard]] const char* broken_rule(const Settings& settings) noexcept;

/// @param settings validated: broken_rule() is nullptr
[[nodiscard]] std::unique_ptr<Device<InertialReading>> make_sensor(const Settings& settings);

}  // namespace isobar::xsens
