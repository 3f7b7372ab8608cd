// SPDX-License-Identifier: BSD-3-Clause
// Labelled time spans of a recording, from its segments.csv.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::evaluation {

/// Label of segments on level floors, over which the paper's relative error on z is computed.
inline constexpr std::string_view kFlatLabel = "flat";

/// Labelled time span.
struct Segment {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;  ///< not before start_ns
  std::string label;        ///< "flat", "stairs", "elevator", "ramp", "outdoor" or any other word

  [[nodiscard]] bool contains(std::int64_t stamp_ns) const {
    return start_ns <= stamp_ns && stamp_ns <= end_ns;
  }
};

/// Parses segments.csv (columns t_start_ns, t_end_ns, label in any order).
/// @throws DataError "name:line: rule" when a line breaks a rule
std::vector<Segment> parse_segments_csv(std::string_view text, const std::string& name);

/// Segments with kFlatLabel, in order of time.
std::vector<Segment> flat_segments(const std::vector<Segment>& segments);

}  // namespace isobar::evaluation
