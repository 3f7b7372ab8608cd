// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/segments.hpp"

#include <utility>

#include "core/errors.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::text {

std::vector<Segment> read_segments(TextLines lines) {
  CsvReader csv(std::move(lines), {"t_start_ns", "t_end_ns", "label"});
  std::vector<Segment> segments;
  while (csv.next_row()) {
    Segment segment{csv.int64(0), csv.int64(1), std::string(csv.field(2))};
    if (segment.end_ns < segment.start_ns) {
      throw DataError(csv.lines().place() + "the segment ends before it starts");
    }
    if (segment.label.empty()) {
      throw DataError(csv.lines().place() + "label: is empty");
    }
    segments.push_back(std::move(segment));
  }
  return segments;
}

}  // namespace isobar::text
