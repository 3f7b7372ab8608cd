// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drivers/bus/register_bus.hpp"

namespace isobar {

/// Device on a kernel I2C bus, /dev/i2c-N. Uses SMBus byte reads and writes, and block reads and single bytes
/// if the adapter has them: i2c-stub and the simplest adapters support nothing else.
class SmbusDevice final : public RegisterBus {
 public:
  /// Does not open the bus; open() does.
  /// @param address 7 bit
  SmbusDevice(std::string bus, std::uint8_t address);
  ~SmbusDevice() override;

  /// ENOTSUP: the adapter has no byte reads and writes. EBUSY: a kernel driver holds the device.
  int open() noexcept override;
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override;
  int write(std::uint8_t address, std::uint8_t value) noexcept override;
  int command(std::uint8_t code) noexcept override;
  [[nodiscard]] bool bursts() const noexcept override { return has_block_reads_; }

 private:
  void close() noexcept;
  int read_byte(std::uint8_t address, std::uint8_t& value) noexcept;
  int read_block(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept;

  std::string bus_;
  std::uint8_t address_;
  int file_ = -1;
  bool has_block_reads_ = false;
  bool has_commands_ = false;
};

}  // namespace isobar
