// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "run/recording/input_log.hpp"
#include "run/tile_store/file_descriptor.hpp"

namespace isobar::black_box {

/// A segment of the ring, opened for reading: it stays readable after the ring has dropped it.
struct OpenSegment {
  FileDescriptor file;
  std::uint64_t bytes = 0;  ///< to be read
};

/// The newest inputs in segment files in memory. Each segment begins with the description of the run, so that
/// any sequence of segments can be read. What is written survives the process. One thread.
class Ring {
 public:
  /// @param folder empty, in a file system in memory
  /// @param span_ns time that is held at least, memory permitting
  /// @param limit_bytes most memory
  Ring(std::filesystem::path folder, std::int64_t span_ns, std::uint64_t limit_bytes);

  /// Records with which every segment begins. From the next append() on; begins a new segment.
  void set_head(const recording::InputLog& head);
  /// Appends whole records; drops the segments that are too old or too many.
  /// @param now_ns CLOCK_MONOTONIC, not decreasing
  /// @return false when the file system refuses: the records are lost
  bool append(const recording::InputLog& log, std::int64_t now_ns);

  /// All segments, oldest first.
  [[nodiscard]] std::vector<OpenSegment> open_all() const;
  /// Deletes the folder: at a clean end.
  void remove();

  [[nodiscard]] std::int64_t held_ns(std::int64_t now_ns) const;
  [[nodiscard]] std::uint64_t held_bytes() const { return held_bytes_; }
  [[nodiscard]] std::uint64_t limit_bytes() const { return limit_bytes_; }

 private:
  struct Segment {
    std::filesystem::path path;
    std::int64_t first_ns = 0;
    std::uint64_t bytes = 0;
  };

  bool begin_segment(std::int64_t now_ns);
  bool write(std::span<const std::uint8_t> bytes);
  bool write_once(std::span<const std::uint8_t> bytes);
  void drop_oldest();

  std::filesystem::path folder_;
  std::int64_t span_ns_;
  std::uint64_t limit_bytes_;
  std::vector<std::uint8_t> head_;
  std::deque<Segment> segments_;  // oldest first; the last one is being written
  FileDescriptor file_;           // of the last one; none: the next append begins a segment
  std::uint64_t held_bytes_ = 0;
  std::uint64_t number_ = 0;  // of the next segment
};

/// The segments of a ring's folder, oldest first.
[[nodiscard]] std::vector<OpenSegment> open_segments(const std::filesystem::path& folder);

}  // namespace isobar::black_box
