// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/black_box_ring.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace isobar::black_box {
namespace {

/// Segments of a full ring. The ring holds up to one segment more than its span.
constexpr std::int64_t kSegments = 12;
constexpr const char* kSegmentSuffix = ".inputs";

OpenSegment open_segment(const std::filesystem::path& path) {
  OpenSegment segment{FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)), 0};
  struct stat status {};
  if (segment.file && ::fstat(segment.file.get(), &status) == 0 && S_ISREG(status.st_mode)) {
    segment.bytes = static_cast<std::uint64_t>(status.st_size);
  }
  return segment;
}

}  // namespace

std::vector<OpenSegment> open_segments(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == kSegmentSuffix) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<OpenSegment> segments;
  segments.reserve(paths.size());
  for (const auto& path : paths) segments.push_back(open_segment(path));
  return segments;
}

Ring::Ring(std::filesystem::path folder, std::int64_t span_ns, std::uint64_t limit_bytes)
    : folder_(std::move(folder)), span_ns_(span_ns), limit_bytes_(limit_bytes) {}

void Ring::set_head(const recording::InputLog& head) {
  head_.assign(head.bytes().begin(), head.bytes().end());
  file_ = FileDescriptor();
}

bool Ring::append(const recording::InputLog& log, std::int64_t now_ns) {
  if (log.bytes().empty()) return true;
  const bool full =
      !segments_.empty() && (now_ns - segments_.back().first_ns >= span_ns_ / kSegments ||
                             segments_.back().bytes >= limit_bytes_ / static_cast<std::uint64_t>(kSegments));
  if ((!file_ || full) && !begin_segment(now_ns)) return false;
  // A segment is too old once the one after it covers the span.
  while (segments_.size() > 1 && now_ns - segments_[1].first_ns >= span_ns_) drop_oldest();
  while (segments_.size() > 1 && held_bytes_ + log.bytes().size() > limit_bytes_) drop_oldest();
  return write(log.bytes());
}

bool Ring::begin_segment(std::int64_t now_ns) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%010llu%s", static_cast<unsigned long long>(number_++),
                kSegmentSuffix);
  const std::filesystem::path path = folder_ / name.data();
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC;
  file_ = FileDescriptor(::open(path.c_str(), kFlags, S_IRUSR | S_IWUSR));
  if (!file_) return false;
  segments_.push_back({path, now_ns, 0});
  return write(head_);
}

// A full file system takes the oldest segments; their space is free at once.
bool Ring::write(std::span<const std::uint8_t> bytes) {
  while (!write_once(bytes)) {
    if (segments_.size() < 2) return false;
    drop_oldest();
  }
  return true;
}

bool Ring::write_once(std::span<const std::uint8_t> bytes) {
  Segment& segment = segments_.back();
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(file_.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      // Whole records only: what was written of this batch is taken back.
      [[maybe_unused]] const int refused = ::ftruncate(file_.get(), static_cast<off_t>(segment.bytes));
      return false;
    }
    done += static_cast<std::size_t>(count);
  }
  segment.bytes += done;
  held_bytes_ += done;
  return true;
}

void Ring::drop_oldest() {
  ::unlink(segments_.front().path.c_str());
  held_bytes_ -= segments_.front().bytes;
  segments_.pop_front();
}

std::vector<OpenSegment> Ring::open_all() const {
  std::vector<OpenSegment> segments;
  for (const Segment& segment : segments_) {
    segments.push_back(open_segment(segment.path));
    segments.back().bytes = std::min(segments.back().bytes, segment.bytes);
  }
  return segments;
}

void Ring::remove() {
  file_ = FileDescriptor();
  segments_.clear();
  held_bytes_ = 0;
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::int64_t Ring::held_ns(std::int64_t now_ns) const {
  return segments_.empty() ? 0 : now_ns - segments_.front().first_ns;
}

}  // namespace isobar::black_box
