// SPDX-License-Identifier: BSD-3-Clause
// Height errors by floor.
#pragma once

#include <vector>

#include "run/evaluation/figures.hpp"

namespace isobar::evaluation {

/// Height errors of each floor, lowest first. Flat segments are grouped into floors by the reference's mean
/// height: a gap above `floor_gap_m` in the sorted heights separates two floors. Segments without a pose are
/// left out.
std::vector<FloorHeight> floor_heights(const std::vector<PosePair>& pairs, const std::vector<Segment>& flat,
                                       double floor_gap_m);

}  // namespace isobar::evaluation
