// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/segments.hpp"

#include <algorithm>

namespace isobar::evaluation {

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
