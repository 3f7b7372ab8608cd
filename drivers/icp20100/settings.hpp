// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/bus/spi.hpp"
#include "drivers/icp20100/conversion.hpp"

namespace isobar::icp20100 {

/// Where an ICP-20100 is and how it measures.
struct Settings {
  std::string bus = "/dev/i2c-1";  ///< the kernel's I2C device, or "/dev/spidev0.0"
  std::string address = "0x63";    ///< on I2C: "0x63", or "0x64" with ADDR high
  int rate_hz = 120;               ///< one of kModes: the fastest one filters least
};

/// Data sheet 5.3 "SPI interface": a code for read or write comes before the address.
inline constexpr SpiFormat kSpiFormat{.read_bit = 0, .read_code = 0x3C, .write_code = 0x33};

}  // namespace isobar::icp20100
