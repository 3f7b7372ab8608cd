// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "run/recording/live_recording.hpp"

namespace isobar::tools {

/// What a progress line of `isobar record` shows.
struct RecordFigures {
  recording::LiveCounts counts;
  std::uint64_t bytes = 0;
  std::uint64_t free_bytes = 0;
  std::uint64_t lost = 0;
  std::int64_t now_ns = 0;  ///< CLOCK_MONOTONIC
};

/// The progress line of `isobar record` on stderr: redrawn every second on a terminal, a line every ten
/// seconds in a pipe.
class RecordProgress {
 public:
  RecordProgress();
  ~RecordProgress();
  RecordProgress(const RecordProgress&) = delete;
  RecordProgress& operator=(const RecordProgress&) = delete;

  /// Call once a second.
  void update(const RecordFigures& now);
  /// Ends a redrawn line, so that other text begins on its own one.
  void end_line();

 private:
  bool terminal_;
  bool line_open_ = false;
  std::int64_t started_ns_ = 0;
  RecordFigures last_;  ///< of the last printed line
};

}  // namespace isobar::tools
