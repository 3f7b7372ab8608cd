// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <span>
#include <vector>

#include "drivers/bus/choice.hpp"
#include "drivers/bus/smbus.hpp"
#include "drivers/bus/spi.hpp"

namespace isobar::test::test_bus {

namespace {

std::vector<int> sent(const SpiFrame& frame) {
  return {frame.bytes.begin(), frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.size)};
}

}  // namespace

TEST_CASE("an SPI read marks its address by bit 7, and the answer follows it") {
  const SpiFrame frame = spi_read_frame({}, 0x1D, 6);
  CHECK(sent(frame) == std::vector<int>{0x9D, 0, 0, 0, 0, 0, 0});
  CHECK(frame.data_at == 1);
  CHECK(sent(spi_write_frame({}, 0xFE, 0xB6)) == std::vector<int>{0x7E, 0xB6});  // bit 7 means a read
}

TEST_CASE("a dummy byte moves the answer by one") {
  const SpiFrame frame = spi_read_frame({.dummy_bytes = 1}, 0x04, 2);
  CHECK(sent(frame) == std::vector<int>{0x84, 0, 0, 0});
  CHECK(frame.data_at == 2);
}

TEST_CASE("codes for read and write come before the whole address") {
  const SpiFormat format{.read_bit = 0, .read_code = 0x3C, .write_code = 0x33};
  const SpiFrame frame = spi_read_frame(format, 0xFA, 1);
  CHECK(sent(frame) == std::vector<int>{0x3C, 0xFA, 0});
  CHECK(frame.data_at == 2);
  CHECK(sent(spi_write_frame(format, 0xC0, 0x28)) == std::vector<int>{0x33, 0xC0, 0x28});
}

TEST_CASE("the longest read fits into a frame in every format") {
  const SpiFormat format{.read_bit = 0, .read_code = 0x3C, .dummy_bytes = 1};
  const SpiFrame frame = spi_read_frame(format, 0, SpiFrame::kMaxRead);
  CHECK(frame.size == frame.data_at + SpiFrame::kMaxRead);
  SpiDevice device("/dev/null", format);
  std::array<std::uint8_t, SpiFrame::kMaxRead + 1> bytes{};
  CHECK(device.read(0, bytes) == EINVAL);
}

TEST_CASE("a missing SPI bus, or a file that is not a bus, gives an errno and no crash") {
  SpiDevice missing("/dev/spidev9.9", {});
  CHECK(missing.open() == ENOENT);
  SpiDevice none("/dev/null", {});
  CHECK(none.open() == ENOTTY);
  std::uint8_t byte = 0;
  CHECK(none.read(0x0D, {&byte, 1}) == EBADF);
  CHECK(none.write(0x0C, 0x89) == EBADF);
  CHECK(none.command(0x1E) == EBADF);
  SmbusDevice smbus("/dev/null", 0x77);
  CHECK(smbus.open() == ENOTTY);
  CHECK(smbus.command(0x1E) == EBADF);
  CHECK_FALSE(smbus.bursts());
}

TEST_CASE("the name of a bus tells SPI from I2C") {
  CHECK(is_spi("/dev/spidev0.0"));
  CHECK(is_spi("spidev1.0"));
  CHECK_FALSE(is_spi("/dev/i2c-1"));
  CHECK_FALSE(is_spi("/dev/i2c-spidev"));
  CHECK_FALSE(is_spi(""));
  CHECK(place_on_bus("BMP581", "/dev/i2c-1", "0x47") == "BMP581 on /dev/i2c-1 at 0x47");
  CHECK(place_on_bus("BMP581", "/dev/spidev0.0", "0x47") == "BMP581 on /dev/spidev0.0");
  CHECK(dynamic_cast<SpiDevice*>(make_register_bus("/dev/spidev0.0", "", {}).get()) != nullptr);
  CHECK(dynamic_cast<SmbusDevice*>(make_register_bus("/dev/i2c-1", "0x46", {}).get()) != nullptr);
}

}  // namespace isobar::test::test_bus
