// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

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

/// Bytes of a packet of the output that is set up: header, time, Imu, Temp, Pres, CRC; Quaternion.
[[nodiscard]] constexpr int packet_bytes(const Settings& settings) noexcept {
  return 6 + 8 + 24 + 4 + 4 + 2 + (settings.attitude ? 16 : 0);
}

/// The rule that the settings break, nullptr: none. Packets must fill at most 0.9 of the line.
[[nodiscard]] constexpr const char* broken_rule(const Settings& settings) noexcept {
  if (settings.rate_hz <= 0 || kSensorRateHz % settings.rate_hz != 0) {
    return "rate_hz must divide the sensor's 800 Hz";
  }
  constexpr int kBitsPerByte = 10;
  const std::int64_t bits_per_s = std::int64_t{packet_bytes(settings)} * settings.rate_hz * kBitsPerByte;
  const bool fits = bits_per_s <= std::int64_t{settings.baud} * 9 / 10;
  return fits || !settings.configure
             ? nullptr
             : "the packets fill more than 0.9 of the line: raise baud or lower rate_hz";
}

}  // namespace isobar::vn100
