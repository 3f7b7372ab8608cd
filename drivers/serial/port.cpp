// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/serial/port.hpp"

// termios2 is the kernel's, and <termios.h> defines names that collide with its header.
#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace isobar::serial {

namespace {

constexpr std::int64_t kBitsPerByte = 10;
/// Largest deviation of the rate that the hardware sets: asynchronous receivers tolerate 2 % each side.
constexpr std::int64_t kBaudTolerance = 50;  // one part in 50

bool near(std::int64_t actual, std::int64_t wanted) {
  return std::llabs(actual - wanted) * kBaudTolerance <= wanted;
}

}  // namespace

Port::Port(std::string path, int baud) : path_(std::move(path)), baud_(baud) {}

Port::~Port() { close(); }

void Port::close() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
  low_latency_ = false;
}

int Port::open() noexcept {
  close();
  // O_NONBLOCK also keeps open() from waiting for a modem's carrier.
  file_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) return errno;
  const int error = set_up();
  if (error != 0) close();
  return error;
}

int Port::set_up() noexcept {
  // TIOCEXCL does not bind a process with CAP_SYS_ADMIN; the lock, which terminal programs take too, does.
  if (flock(file_, LOCK_EX | LOCK_NB) < 0) return errno == EWOULDBLOCK ? EBUSY : errno;
  if (ioctl(file_, TIOCEXCL) < 0) return errno;
  termios2 settings{};
  if (ioctl(file_, TCGETS2, &settings) < 0) return errno;
  settings.c_iflag = IGNBRK | IGNPAR;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (static_cast<tcflag_t>(BOTHER) << IBSHIFT);
  settings.c_ispeed = static_cast<speed_t>(baud_);
  settings.c_ospeed = static_cast<speed_t>(baud_);
  // With O_NONBLOCK: "nothing waiting" is EAGAIN, so that 0 bytes mean a hang-up.
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  if (ioctl(file_, TCSETS2, &settings) < 0) return errno;
  if (ioctl(file_, TCGETS2, &settings) < 0) return errno;
  if (!near(settings.c_ospeed, baud_)) return ERANGE;
  set_low_latency();
  return ioctl(file_, TCFLSH, TCIOFLUSH) < 0 ? errno : 0;
}

void Port::set_low_latency() noexcept {
  serial_struct serial{};
  if (ioctl(file_, TIOCGSERIAL, &serial) < 0) return;
  serial.flags |= ASYNC_LOW_LATENCY;
  if (ioctl(file_, TIOCSSERIAL, &serial) < 0) return;
  serial = {};
  low_latency_ = ioctl(file_, TIOCGSERIAL, &serial) == 0 && (serial.flags & ASYNC_LOW_LATENCY) != 0;
}

Port::Result Port::read(std::span<std::uint8_t> bytes) noexcept {
  Result result;
  if (bytes.empty()) return result;
  const ssize_t count = ::read(file_, bytes.data(), bytes.size());
  if (count > 0) {
    result.count = static_cast<std::size_t>(count);
  } else if (count == 0) {
    result.error = ENODEV;  // hung up
  } else if (errno != EAGAIN && errno != EINTR) {
    result.error = errno;
  }
  return result;
}

int Port::write(std::span<const std::uint8_t> bytes) noexcept {
  const ssize_t count = ::write(file_, bytes.data(), bytes.size());
  if (count < 0) return errno;
  return static_cast<std::size_t>(count) == bytes.size() ? 0 : EAGAIN;
}

std::int64_t Port::line_time_ns(std::size_t bytes) const noexcept {
  return static_cast<std::int64_t>(bytes) * kBitsPerByte * 1'000'000'000 / baud_;
}

}  // namespace isobar::serial
