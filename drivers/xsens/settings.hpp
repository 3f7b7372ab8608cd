// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

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

/// Bytes of a message of the output that is set up: frame, counter, time, acceleration, rate of turn; quaternion;
/// pressure and temperature.
[[nodiscard]] constexpr int message_bytes(const Settings& settings) noexcept {
  return 5 + 5 + 7 + 15 + 15 + (settings.attitude ? 19 : 0) + (settings.pressure ? 14 : 0);
}

/// The rule that the settings break, nullptr: none. Messages must fill at most 0.9 of the line.
[[nodiscard]] constexpr const char* broken_rule(const Settings& settings) noexcept {
  constexpr int kFastestHz = 400;
  if (settings.rate_hz <= 0 || kFastestHz % settings.rate_hz != 0) return "rate_hz must divide 400 Hz";
  constexpr int kBitsPerByte = 10;
  const std::int64_t bits_per_s = std::int64_t{message_bytes(settings)} * settings.rate_hz * kBitsPerByte;
  const bool fits = bits_per_s <= std::int64_t{settings.baud} * 9 / 10;
  return fits || !settings.configure
             ? nullptr
             : "the messages fill more than 0.9 of the line: raise baud or lower rate_hz";
}

}  // namespace isobar::xsens
