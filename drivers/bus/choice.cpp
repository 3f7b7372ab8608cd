// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bus/choice.hpp"

#include <charconv>
#include <cstdint>

#include "drivers/bus/smbus.hpp"

namespace isobar {

bool is_spi(const std::string& bus) noexcept {
  const std::size_t slash = bus.rfind('/');
  return bus.compare(slash == std::string::npos ? 0 : slash + 1, 6, "spidev") == 0;
}

std::unique_ptr<RegisterBus> make_register_bus(const std::string& bus, const std::string& address,
                                               const SpiFormat& format) {
  if (is_spi(bus)) return std::make_unique<SpiDevice>(bus, format);
  std::uint8_t number = 0;
  const std::size_t digits = address.starts_with("0x") ? 2 : 0;
  std::from_chars(address.data() + digits, address.data() + address.size(), number, 16);
  return std::make_unique<SmbusDevice>(bus, number);
}

std::string place_on_bus(const std::string& sensor, const std::string& bus, const std::string& address) {
  std::string place = sensor + " on " + bus;
  if (!is_spi(bus)) place += " at " + address;
  return place;
}

}  // namespace isobar
