// SPDX-License-Identifier: BSD-3-Clause
// A serial port of the kernel: raw bytes at any baud rate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace isobar::serial {

/// A tty in raw mode, 8 data bits, no parity, 1 stop bit, no flow control; never the controlling terminal, and
/// held exclusively. No call waits or throws. One thread.
class Port {
 public:
  /// Does not open the port; open() does.
  /// @param path "/dev/ttyUSB0"
  /// @param baud symbols per second, any that the hardware divides to within 2 %
  Port(std::string path, int baud);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Opens anew and drops the bytes that the kernel holds.
  /// @return 0 or errno; EBUSY: another program holds the port; ENOTTY: not a tty; ERANGE: the hardware has no
  ///         such baud rate
  int open() noexcept;
  void close() noexcept;

  struct Result {
    int error = 0;          ///< 0 or errno; EIO or ENODEV: the device is gone
    std::size_t count = 0;  ///< bytes read; 0 without an error: none is waiting
  };
  Result read(std::span<std::uint8_t> bytes) noexcept;
  /// @return 0 or errno; EAGAIN: not all bytes fit the kernel's buffer
  int write(std::span<const std::uint8_t> bytes) noexcept;

  [[nodiscard]] int file_descriptor() const noexcept { return file_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] int baud() const noexcept { return baud_; }
  /// The driver took ASYNC_LOW_LATENCY. Without it, USB adapters hold bytes back: FTDI's for 16 ms. False for
  /// a driver that has no such flag (CDC-ACM, pseudo-terminals).
  [[nodiscard]] bool low_latency() const noexcept { return low_latency_; }
  /// Time that `bytes` take on the line [ns]: 10 bits each, with start and stop bit.
  [[nodiscard]] std::int64_t line_time_ns(std::size_t bytes) const noexcept;

 private:
  int set_up() noexcept;
  void set_low_latency() noexcept;

  std::string path_;
  int baud_;
  int file_ = -1;
  bool low_latency_ = false;
};

}  // namespace isobar::serial
