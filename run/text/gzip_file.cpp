// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/gzip_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <system_error>

#include "core/errors.hpp"

namespace isobar::text {
namespace {

constexpr unsigned kZlibBufferBytes = 128 * 1024;

}  // namespace

GzipFile::GzipFile(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw DataError(name_ + ": is a folder, must be a file");
  }
  errno = 0;
  file_ = gzopen(file.c_str(), "rbe");
  if (file_ == nullptr) {
    throw DataError(name_ + ": cannot be read: " + std::strerror(errno == 0 ? ENOMEM : errno));
  }
  gzbuffer(file_, kZlibBufferBytes);
  std::array<char, kHeadBytes> head{};
  head_.assign(head.data(), read_on(head.data(), head.size()));
}

GzipFile::~GzipFile() { gzclose(file_); }

std::size_t GzipFile::read_on(char* to, std::size_t size) {
  const int count = gzread(file_, to, static_cast<unsigned>(std::min<std::size_t>(size, INT_MAX)));
  if (count > 0) return static_cast<std::size_t>(count);
  // The error of a cut file stands while decompressed bytes are left, hence it is looked for at the end only.
  int error = Z_OK;
  const char* text = gzerror(file_, &error);
  if (error != Z_OK && error != Z_STREAM_END && damage_.empty()) {
    // zlib puts the path in front.
    const std::string reason = error == Z_ERRNO ? std::strerror(errno) : text;
    damage_ = reason.starts_with(name_ + ": ") ? reason.substr(name_.size() + 2) : reason;
  }
  return 0;
}

std::size_t GzipFile::read(char* to, std::size_t size) {
  std::size_t count = std::min(size, head_.size() - head_given_);
  std::copy_n(head_.data() + head_given_, count, to);
  head_given_ += count;
  if (count == 0) count = read_on(to, size);
  position_ += count;
  return count;
}

/// zlib does not tell the decompressed size: only reading does.
std::uint64_t GzipFile::decompressed_size() {
  std::error_code error;
  if (gzdirect(file_) != 0) {
    const std::uint64_t size = std::filesystem::file_size(name_, error);
    return error ? 0 : size;
  }
  std::uint64_t size = std::max<std::uint64_t>(position_, head_.size());
  std::vector<char> unused(kZlibBufferBytes);
  while (const std::size_t count = read_on(unused.data(), unused.size())) size += count;
  return size;
}

bool GzipFile::skip_to_last(std::uint64_t bytes, std::uint64_t unread) {
  const std::uint64_t size = decompressed_size();
  const bool past = size < bytes || size - bytes <= position_ - unread;
  const std::uint64_t target = past ? std::max<std::uint64_t>(position_, head_given_) : size - bytes;
  damage_.clear();  // reading again finds it again
  gzclearerr(file_);
  // Position of zlib: the head was read ahead.
  const std::uint64_t zlib_target = past ? std::max<std::uint64_t>(target, head_.size()) : target;
  if (gzseek(file_, static_cast<z_off_t>(zlib_target), SEEK_SET) < 0) {
    return false;
  }
  if (past) return false;
  head_given_ = head_.size();
  position_ = target;
  return true;
}

std::uint64_t GzipFile::bytes_read() const {
  const z_off_t offset = gzoffset(file_);
  return offset < 0 ? 0 : static_cast<std::uint64_t>(offset);
}

}  // namespace isobar::text
