// SPDX-License-Identifier: BSD-3-Clause
// The bus that a setting names: "/dev/i2c-1" with an address, or "/dev/spidev0.0".
#pragma once

#include <memory>
#include <string>

#include "drivers/bus/register_bus.hpp"
#include "drivers/bus/spi.hpp"

namespace isobar {

/// True for a file name that begins with "spidev"; every other bus is I2C.
[[nodiscard]] bool is_spi(const std::string& bus) noexcept;

/// @param address "0x77"; without a meaning on SPI
/// @param format of the sensor on SPI
[[nodiscard]] std::unique_ptr<RegisterBus> make_register_bus(const std::string& bus,
                                                             const std::string& address,
                                                             const SpiFormat& format);

/// "DPS310 on /dev/i2c-1 at 0x77", "DPS310 on /dev/spidev0.0".
[[nodiscard]] std::string place_on_bus(const std::string& sensor, const std::string& bus,
                                       const std::string& address);

}  // namespace isobar
