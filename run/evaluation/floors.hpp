// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "run/evaluation/figures.hpp"

namespace isobar::evaluation {

/// Gathers flat segments into floors by the reference's mean height (a gap above `floor_gap_m` in the sorted
/// heights parts two floors) and compares the heights. Segments without a pose are left out. Lowest floor
/// first.
std::vector<FloorHeight> floor_heights(const std::vector<PosePair>& pairs, const std::vector<Segment>& flat,
                                       double floor_gap_m);

}  // namespace isobar::evaluation
