// SPDX-License-Identifier: BSD-3-Clause
// Segments over which figures are taken.
#pragma once

#include <string_view>
#include <vector>

#include "run/text/segments.hpp"

namespace isobar::evaluation {

/// Label of the segments on level floors, over which the paper's relative error on z is taken.
inline constexpr std::string_view kFlatLabel = "flat";

using text::Segment;

/// Segments with kFlatLabel, in order of time.
std::vector<Segment> flat_segments(const std::vector<Segment>& segments);

}  // namespace isobar::evaluation
