// SPDX-License-Identifier: BSD-3-Clause
// Named time spans of a recording: segments.csv.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "run/text/text_lines.hpp"

namespace isobar::text {

struct Segment {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;  ///< not before start_ns
  std::string label;        ///< "flat", "stairs", "elevator", "ramp", "outdoor" or any other word

  [[nodiscard]] bool contains(std::int64_t stamp_ns) const {
    return start_ns <= stamp_ns && stamp_ns <= end_ns;
  }
};

/// Reads segments.csv: columns t_start_ns, t_end_ns, label in any order.
/// @throws DataError "name:line: rule" when a line breaks the format
std::vector<Segment> read_segments(TextLines lines);

}  // namespace isobar::text
