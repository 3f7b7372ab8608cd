// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/segments.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "run/evaluation/text_table.hpp"

namespace isobar::evaluation {

std::vector<Segment> parse_segments_csv(std::string_view text, const std::string& name) {
  CsvReader csv(text, name);
  const std::size_t start_column = csv.required_column("t_start_ns");
  const std::size_t end_column = csv.required_column("t_end_ns");
  const std::size_t label_column = csv.required_column("label");
  std::vector<Segment> segments;
  while (csv.next_row()) {
    Segment segment{csv.int64(start_column), csv.int64(end_column), std::string(csv.cell(label_column))};
    if (segment.end_ns < segment.start_ns) throw DataError(csv.where() + "the segment ends before it starts");
    if (segment.label.empty()) throw DataError(csv.where() + "label: is empty");
    segments.push_back(std::move(segment));
  }
  return segments;
}

std::vector<Segment> flat_segments(const std::vector<Segment>& segments) {
  std::vector<Segment> flat;
  for (const Segment& segment : segments) {
    if (segment.label == kFlatLabel) flat.push_back(segment);
  }
  std::sort(flat.begin(), flat.end(),
            [](const Segment& a, const Segment& b) { return a.start_ns < b.start_ns; });
  return flat;
}

}  // namespace isobar::evaluation
