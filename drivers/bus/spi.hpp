// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "drivers/bus/register_bus.hpp"

namespace isobar {

/// How a device marks reads and writes of registers on SPI, from its data sheet.
struct SpiFormat {
  std::uint8_t read_bit = 0x80;  ///< set in the address of a read, cleared in that of a write; 0: no such bit
  std::uint8_t read_code = 0;    ///< byte before the address of a read; 0: none
  std::uint8_t write_code = 0;   ///< byte before the address of a write; 0: none
  std::size_t dummy_bytes = 0;   ///< bytes between the address and the first byte read
};

/// Bytes that the master sends in one transaction.
struct SpiFrame {
  static constexpr std::size_t kMaxRead = 32;
  std::array<std::uint8_t, kMaxRead + 4> bytes{};
  std::size_t size = 0;
  std::size_t data_at = 0;  ///< index of the first byte that answers a read
};

/// @param count at most SpiFrame::kMaxRead
[[nodiscard]] SpiFrame spi_read_frame(const SpiFormat& format, std::uint8_t first,
                                      std::size_t count) noexcept;
[[nodiscard]] SpiFrame spi_write_frame(const SpiFormat& format, std::uint8_t address,
                                       std::uint8_t value) noexcept;

/// Device on a kernel SPI bus, /dev/spidevB.C, in SPI mode 3 at 1 MHz, which all barometers support. SPI has
/// no acknowledgement: a missing device reads as constant bytes, and its identification fails.
class SpiDevice final : public RegisterBus {
 public:
  /// Does not open the bus; open() does.
  SpiDevice(std::string bus, const SpiFormat& format);
  ~SpiDevice() override;

  int open() noexcept override;
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override;
  int write(std::uint8_t address, std::uint8_t value) noexcept override;
  int command(std::uint8_t code) noexcept override;

 private:
  void close() noexcept;
  /// One transaction; the answer replaces the frame's bytes.
  int transfer(SpiFrame& frame) noexcept;

  std::string bus_;
  SpiFormat format_;
  int file_ = -1;
};

}  // namespace isobar
