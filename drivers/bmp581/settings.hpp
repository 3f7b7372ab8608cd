// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/bmp581/conversion.hpp"
#include "drivers/bus/spi.hpp"

namespace isobar::bmp581 {

/// Where a BMP581 is and how it measures. Oversamplings are powers of two.
struct Settings {
  std::string bus = "/dev/i2c-1";  ///< the kernel's I2C device, or "/dev/spidev0.0"
  std::string address = "0x47";    ///< on I2C: "0x47", or "0x46" with SDO to ground
  int rate_hz = 50;                ///< one of kRates
  int pressure_oversampling = 16;
  int temperature_oversampling = 1;
  int iir_coefficient = 0;  ///< 0 (off), 1, 3, 7, 15, 31, 63 or 127
};

/// Data sheet, chapter 5.6 "SPI": bit 7 of the address marks a read.
inline constexpr SpiFormat kSpiFormat{};

/// Measurement time per second [s]: temperature and pressure are measured one after the other, so it must be
/// below 1 s (data sheet table 7; the chip checks it, too: OSR_EFF.odr_is_valid).
[[nodiscard]] constexpr double busy_time_s(const Settings& settings) noexcept {
  return settings.rate_hz * (pressure_time_s(settings.pressure_oversampling) +
                             temperature_time_s(settings.temperature_oversampling));
}

}  // namespace isobar::bmp581
