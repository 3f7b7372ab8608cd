// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/small_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace isobar::text {
namespace {

constexpr const char* kNoRegularFile = "is no regular file, but a pipe, a device or a socket";

std::string too_large(std::size_t most_bytes) {
  return "is larger than " + std::to_string(most_bytes / 1024) + " KiB, the largest size";
}

/// Why a file of this kind is not read; empty for a regular file.
std::string refusal_of(const struct stat& status, std::size_t most_bytes) {
  if (S_ISDIR(status.st_mode)) return "is a folder, must be a file";
  if (!S_ISREG(status.st_mode)) return kNoRegularFile;
  if (status.st_size > static_cast<off_t>(most_bytes)) return too_large(most_bytes);
  return {};
}

}  // namespace

SmallFile read_small_file(const std::filesystem::path& file, std::size_t most_bytes) {
  // O_NONBLOCK: opening a FIFO without a writer would block.
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) {
    const int reason = errno;
    if (reason == ENXIO) return {{}, kNoRegularFile};  // a socket, or a device node without a device
    const bool missing = reason == ENOENT || reason == ENOTDIR;
    return {{}, missing ? "no such file" : std::string("cannot be read: ") + std::strerror(reason)};
  }
  SmallFile result;
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) {
    result.refusal = std::string("cannot be read: ") + std::strerror(errno);
  } else {
    result.refusal = refusal_of(status, most_bytes);
  }
  // Files of /proc have size 0: the limit is checked while reading, too.
  result.content.resize(result.refusal.empty() ? most_bytes + 1 : 0);
  std::size_t size = 0;
  while (result.refusal.empty() && size < result.content.size()) {
    const ssize_t got = ::read(descriptor, result.content.data() + size, result.content.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) result.refusal = std::string("cannot be read: ") + std::strerror(errno);
    if (got <= 0) break;
    size += static_cast<std::size_t>(got);
  }
  ::close(descriptor);
  if (size > most_bytes) result.refusal = too_large(most_bytes);
  result.content.resize(result.refusal.empty() ? size : 0);
  return result;
}

}  // namespace isobar::text
