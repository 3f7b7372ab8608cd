// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/bmp390/compensation.hpp"
#include "drivers/bus/spi.hpp"

namespace isobar::bmp390 {

/// Where a BMP390 is and how it measures. Oversamplings are powers of two, 1 … 32.
struct Settings {
  std::string bus = "/dev/i2c-1";  ///< the kernel's I2C device, or "/dev/spidev0.0"
  std::string address = "0x77";    ///< on I2C: "0x77", or "0x76" with SDO to ground
  int rate_hz = 50;                ///< 25, 50, 100 or 200
  int pressure_oversampling = 8;
  int temperature_oversampling = 1;
  int iir_coefficient = 0;  ///< 0 (off), 1, 3, 7, 15, 31, 63 or 127
};

/// Data sheet 5.3.2 "SPI read": bit 7 of the address marks a read, and a dummy byte comes before the data.
inline constexpr SpiFormat kSpiFormat{.dummy_bytes = 1};

/// Measurement time per second [s]; must be below 1 s (the chip checks it, too: ERR_REG.conf_err).
[[nodiscard]] constexpr double busy_time_s(const Settings& settings) noexcept {
  return settings.rate_hz *
         measurement_time_s(settings.pressure_oversampling, settings.temperature_oversampling);
}

}  // namespace isobar::bmp390
