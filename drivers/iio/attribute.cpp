// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/attribute.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace isobar::iio {

namespace {

int open_attribute(const std::string& folder, std::string_view name, int flags) {
  std::array<char, 512> path{};
  const int length = std::snprintf(path.data(), path.size(), "%s/%.*s", folder.c_str(),
                                   static_cast<int>(name.size()), name.data());
  if (length < 0 || static_cast<std::size_t>(length) >= path.size()) {
    errno = ENAMETOOLONG;
    return -1;
  }
  return ::open(path.data(), flags | O_CLOEXEC);
}

/// Entry of getdents64(2): the C library declares none.
struct Entry {
  static constexpr std::size_t kLengthAt = 16;
  static constexpr std::size_t kNameAt = 19;
};

}  // namespace

Attribute read_attribute(const std::string& folder, std::string_view name) noexcept {
  Attribute attribute;
  const int file = open_attribute(folder, name, O_RDONLY);
  if (file < 0) {
    attribute.error = errno;
    return attribute;
  }
  const ssize_t count = ::read(file, attribute.text.data(), attribute.text.size());
  if (count < 0) attribute.error = errno;
  ::close(file);
  attribute.length = count > 0 ? static_cast<std::size_t>(count) : 0;
  while (attribute.length > 0 && attribute.text[attribute.length - 1] == '\n') --attribute.length;
  return attribute;
}

int write_attribute(const std::string& folder, std::string_view name, std::string_view text) noexcept {
  const int file = open_attribute(folder, name, O_WRONLY | O_TRUNC);
  if (file < 0) return errno;
  const ssize_t count = ::write(file, text.data(), text.size());
  const int error = count < 0 ? errno : 0;
  ::close(file);
  return error;
}

int read_number(const std::string& folder, std::string_view name, double& value) noexcept {
  const Attribute attribute = read_attribute(folder, name);
  if (attribute.error != 0) return attribute.error;
  const char* end_of_text = attribute.text.data() + attribute.length;
  const auto [end, error] = std::from_chars(attribute.text.data(), end_of_text, value);
  return error == std::errc{} && end == end_of_text && std::isfinite(value) ? 0 : EBADMSG;
}

int for_each_file(const std::string& folder, void (*visit)(void* context, std::string_view name),
                  void* context) noexcept {
  const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return errno;
  std::array<char, 2048> entries{};
  int error = 0;
  for (;;) {
    const long bytes = ::syscall(SYS_getdents64, directory, entries.data(), entries.size());
    if (bytes < 0) error = errno;
    if (bytes <= 0) break;
    for (std::size_t at = 0; at < static_cast<std::size_t>(bytes);) {
      std::uint16_t length = 0;
      std::memcpy(&length, entries.data() + at + Entry::kLengthAt, sizeof length);
      visit(context, entries.data() + at + Entry::kNameAt);
      at += length;
    }
  }
  ::close(directory);
  return error;
}

}  // namespace isobar::iio
