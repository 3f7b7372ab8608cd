// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bus/spi.hpp"

#include <fcntl.h>
#include <linux/spi/spidev.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>

namespace isobar {

namespace {

/// Slow enough for cables of a robot; a result of 6 bytes takes 0.06 ms.
constexpr std::uint32_t kClockHz = 1'000'000;

void append(SpiFrame& frame, std::uint8_t byte) { frame.bytes[frame.size++] = byte; }

}  // namespace

SpiFrame spi_read_frame(const SpiFormat& format, std::uint8_t first, std::size_t count) noexcept {
  SpiFrame frame;
  if (format.read_code != 0) append(frame, format.read_code);
  append(frame, static_cast<std::uint8_t>(first | format.read_bit));
  frame.data_at = frame.size + format.dummy_bytes;
  frame.size = std::min(frame.data_at + count, frame.bytes.size());
  return frame;
}

SpiFrame spi_write_frame(const SpiFormat& format, std::uint8_t address, std::uint8_t value) noexcept {
  SpiFrame frame;
  if (format.write_code != 0) append(frame, format.write_code);
  append(frame, static_cast<std::uint8_t>(address & ~format.read_bit));
  append(frame, value);
  frame.data_at = frame.size;
  return frame;
}

SpiDevice::SpiDevice(std::string bus, const SpiFormat& format) : bus_(std::move(bus)), format_(format) {}

SpiDevice::~SpiDevice() { close(); }

void SpiDevice::close() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

int SpiDevice::open() noexcept {
  close();
  file_ = ::open(bus_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) return errno;
  std::uint8_t mode = SPI_MODE_3;
  std::uint8_t bits = 8;
  std::uint32_t clock_hz = kClockHz;
  if (ioctl(file_, SPI_IOC_WR_MODE, &mode) < 0 || ioctl(file_, SPI_IOC_WR_BITS_PER_WORD, &bits) < 0 ||
      ioctl(file_, SPI_IOC_WR_MAX_SPEED_HZ, &clock_hz) < 0) {
    const int error = errno;
    close();
    return error;
  }
  return 0;
}

int SpiDevice::read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept {
  if (bytes.size() > SpiFrame::kMaxRead) return EINVAL;
  SpiFrame frame = spi_read_frame(format_, first, bytes.size());
  if (const int error = transfer(frame); error != 0) return error;
  std::copy_n(frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.data_at), bytes.size(), bytes.begin());
  return 0;
}

int SpiDevice::write(std::uint8_t address, std::uint8_t value) noexcept {
  SpiFrame frame = spi_write_frame(format_, address, value);
  return transfer(frame);
}

int SpiDevice::command(std::uint8_t code) noexcept {
  SpiFrame frame;
  append(frame, code);
  return transfer(frame);
}

int SpiDevice::transfer(SpiFrame& frame) noexcept {
  spi_ioc_transfer request{};
  request.tx_buf = reinterpret_cast<std::uintptr_t>(frame.bytes.data());
  request.rx_buf = reinterpret_cast<std::uintptr_t>(frame.bytes.data());
  request.len = static_cast<std::uint32_t>(frame.size);
  return ioctl(file_, SPI_IOC_MESSAGE(1), &request) < 0 ? errno : 0;
}

}  // namespace isobar
