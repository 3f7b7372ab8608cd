// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/bus/spi.hpp"
#include "drivers/ms5611/compensation.hpp"

namespace isobar::ms5611 {

/// Where an MS5611 is and how it measures. Oversamplings are 256, 512, 1024, 2048 or 4096.
struct Settings {
  std::string bus = "/dev/i2c-1";  ///< the kernel's I2C device, or "/dev/spidev0.0"
  std::string address = "0x77";    ///< on I2C: "0x77" with CSB to ground, or "0x76"
  int rate_hz = 50;                ///< 1 … 200
  int pressure_oversampling = 4096;
  int temperature_oversampling = 1024;
};

/// Data sheet, "SPI mode": commands as on I2C, without a bit for reads.
inline constexpr SpiFormat kSpiFormat{.read_bit = 0};

/// Conversion time per second [s], pressure plus temperature: one converter serves both, so it must be below
/// 1 s.
[[nodiscard]] constexpr double busy_time_s(const Settings& settings) noexcept {
  return settings.rate_hz * (longest_conversion_s(settings.pressure_oversampling) +
                             longest_conversion_s(settings.temperature_oversampling));
}

}  // namespace isobar::ms5611
