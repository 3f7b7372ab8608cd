// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstdint>
#include <span>

namespace isobar {

/// Register access to one device on a bus. Every call returns 0 or an errno value; nothing throws.
class RegisterBus {
 public:
  RegisterBus() = default;
  virtual ~RegisterBus() = default;
  RegisterBus(const RegisterBus&) = delete;
  RegisterBus& operator=(const RegisterBus&) = delete;

  /// Opens the bus, or reopens it: the adapter may have been unplugged.
  virtual int open() noexcept = 0;
  /// Reads up to 32 consecutive registers, starting at `first`. `bytes` are undefined after an error.
  virtual int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept = 0;
  virtual int write(std::uint8_t address, std::uint8_t value) noexcept = 0;
  /// Sends one byte that is a command, for a device without registers. Its results are read with read(),
  /// whose `first` is then a command, too. ENOTSUP: this bus cannot.
  virtual int command(std::uint8_t /*code*/) noexcept { return ENOTSUP; }
  /// True when read() of several registers is one transaction, which a device answers from one result. Valid
  /// after open().
  [[nodiscard]] virtual bool bursts() const noexcept { return true; }
};

}  // namespace isobar
