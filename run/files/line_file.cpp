// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/line_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/errors.hpp"

namespace isobar::files {

namespace {

std::uint64_t size_of(const FileDescriptor& file) {
  struct stat status {};
  return ::fstat(file.get(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

/// True while `path` names the open file: it was neither deleted nor replaced.
bool is_at(const FileDescriptor& file, const std::filesystem::path& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(file.get(), &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

/// Position after the last line end; 0 without one.
std::uint64_t end_of_lines(const FileDescriptor& file, std::uint64_t size) {
  std::array<char, 4096> block{};
  while (size > 0) {
    const std::uint64_t begin = size > block.size() ? size - block.size() : 0;
    const ssize_t got = ::pread(file.get(), block.data(), size - begin, static_cast<off_t>(begin));
    if (got <= 0) return size;
    const std::string_view text(block.data(), static_cast<std::size_t>(got));
    if (const auto found = text.rfind('\n'); found != std::string_view::npos) return begin + found + 1;
    size = begin;
  }
  return 0;
}

}  // namespace

LineFile::LineFile(std::filesystem::path file, std::string header, Start start)
    : path_(std::move(file)), header_(std::move(header)) {
  if (start == Start::kNew) {
    open(true);
    return;
  }
  try {
    open(false);
  } catch (const ServiceError&) {  // NOLINT(bugprone-empty-catch): the first flush() tries again, and tells
  }
}

void LineFile::open(bool replace) {
  // The folder itself may have been deleted; those above it may be a mount point and are left alone.
  std::error_code ignored;
  std::filesystem::create_directory(path_.parent_path(), ignored);
  const int flags = O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | (replace ? O_TRUNC : 0);
  file_ = FileDescriptor(::open(path_.c_str(), flags, 0644));
  if (!file_) fail("cannot be opened");
  remove_incomplete_line();
  if (size_of(file_) == 0 && !pending_.starts_with(header_)) pending_.insert(0, header_);
}

void LineFile::remove_incomplete_line() {
  const std::uint64_t size = size_of(file_);
  const std::uint64_t end = end_of_lines(file_, size);
  if (end == size) return;
  if (::ftruncate(file_.get(), static_cast<off_t>(end)) != 0) fail("cannot be repaired");
  removed_ += size - end;
}

void LineFile::add(std::string_view line) {
  if (pending_.size() + line.size() > kMaxPendingBytes) {
    ++dropped_;
    return;
  }
  pending_ += line;
}

// Lines must not go into a file that nobody can find any more.
void LineFile::follow_path() {
  if (file_ && is_at(file_, path_)) return;
  file_ = FileDescriptor();
  open(false);
}

void LineFile::flush() {
  if (pending_.empty() && file_) return;
  follow_path();
  const std::uint64_t before = size_of(file_);
  while (!pending_.empty()) {
    const ssize_t put = ::write(file_.get(), pending_.data(), pending_.size());
    if (put < 0 && errno == EINTR) continue;
    const int error = errno;
    if (put > 0) unsynced_ = true;
    if (put == static_cast<ssize_t>(pending_.size())) {
      pending_.clear();
      return;
    }
    // A full disk takes a part: the whole lines of it stay.
    const std::size_t lines =
        put > 0 ? pending_.rfind('\n', static_cast<std::size_t>(put) - 1) + 1 : 0;  // npos + 1 is 0
    const bool repaired = ::ftruncate(file_.get(), static_cast<off_t>(before + lines)) == 0;
    if (repaired) pending_.erase(0, lines);
    errno = put >= 0 ? ENOSPC : error;
    fail("cannot be written");
  }
}

void LineFile::sync() {
  if (!std::exchange(unsynced_, false) || !file_) return;
  // EINVAL: a pipe or a device has no disk.
  if (::fdatasync(file_.get()) != 0 && errno != EINVAL) fail("cannot be written to the disk");
}

void LineFile::fail(const char* what) {
  const std::string reason = errno_message();
  file_ = FileDescriptor();
  throw ServiceError(path_.string() + ": " + what + ": " + reason);
}

}  // namespace isobar::files
