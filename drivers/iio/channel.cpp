// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/channel.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace isobar::iio {

namespace {

constexpr std::size_t kMaxPathBytes = 512;

/// "in_voltage" of "in_voltage0".
std::string without_digits(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (c < '0' || c > '9') text += c;
  }
  return text;
}

/// Parses a sysfs file. pread at 0 makes the kernel compute the attribute again.
int read_number(int file, double& value) noexcept {
  std::array<char, 64> text{};
  const ssize_t length = pread(file, text.data(), text.size(), 0);
  if (length < 0) return errno;
  const auto [end, error] = std::from_chars(text.data(), text.data() + length, value);
  const bool whole = end == text.data() + length || *end == '\n' || *end == ' ';  // units follow a blank
  return error == std::errc{} && whole && std::isfinite(value) ? 0 : EBADMSG;
}

}  // namespace

Channel::Channel(std::string folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)), shared_name_(without_digits(name_)) {}

Channel::~Channel() { close(); }

void Channel::close() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

int Channel::open_file(const char* suffix, bool shared) const noexcept {
  std::array<char, kMaxPathBytes> path{};
  const std::string& name = shared ? shared_name_ : name_;
  const int length =
      std::snprintf(path.data(), path.size(), "%s/%s%s", folder_.c_str(), name.c_str(), suffix);
  if (length < 0 || static_cast<std::size_t>(length) >= path.size()) {
    errno = ENAMETOOLONG;
    return -1;
  }
  return ::open(path.data(), O_RDONLY | O_CLOEXEC);
}

/// Reads an attribute of the channel, or the one shared by all channels of its kind; leaves `value` unchanged
/// when neither exists.
int Channel::read_constant(const char* suffix, double& value) const noexcept {
  int file = open_file(suffix, false);
  if (file < 0 && errno == ENOENT) file = open_file(suffix, true);
  if (file < 0) return errno == ENOENT ? 0 : errno;
  const int error = read_number(file, value);
  ::close(file);
  return error;
}

int Channel::open() noexcept {
  close();
  scale_ = 1.0;
  offset_ = 0.0;
  file_ = open_file("_input", false);
  processed_ = file_ >= 0;
  if (processed_) return 0;
  file_ = open_file("_raw", false);
  if (file_ < 0) return errno;
  if (const int error = read_constant("_scale", scale_); error != 0) return error;
  return read_constant("_offset", offset_);
}

Channel::Value Channel::read() noexcept {
  Value value;
  double number = 0.0;
  value.error = read_number(file_, number);
  if (value.error != 0) return value;
  value.bits = std::bit_cast<std::int64_t>(number);
  value.value = processed_ ? number : (number + offset_) * scale_;
  return value;
}

}  // namespace isobar::iio
