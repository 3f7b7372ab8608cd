// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/bus/spi.hpp"
#include "drivers/dps310/compensation.hpp"

namespace isobar::dps310 {

/// Where a DPS310 is and how it measures. Rates and oversamplings are powers of two.
struct Settings {
  std::string bus = "/dev/i2c-1";  ///< the kernel's I2C device, or "/dev/spidev0.0"
  std::string address = "0x77";    ///< on I2C: "0x77", or "0x76" with SDO to ground
  int pressure_rate_hz = 32;
  int pressure_oversampling = 16;
  int temperature_rate_hz = 4;
  int temperature_oversampling = 8;
  std::string ready_chip = "/dev/gpiochip0";
  int ready_line =
      -1;  ///< line of ready_chip at the sensor's pin SDO, which is its interrupt on I2C; -1: polled
};

/// Data sheet, "SPI Interface": bit 7 of the address marks a read.
inline constexpr SpiFormat kSpiFormat{};

/// Measurement time per second [s], pressure plus temperature: one converter serves both, so it must be below
/// 1 s (data sheet, "Pressure Configuration").
[[nodiscard]] constexpr double busy_time_s(const Settings& settings) noexcept {
  return settings.pressure_rate_hz * measurement_time_s(settings.pressure_oversampling) +
         settings.temperature_rate_hz * measurement_time_s(settings.temperature_oversampling);
}

}  // namespace isobar::dps310
