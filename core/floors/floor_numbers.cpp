// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {

// Storeys between two floors: more than one where an elevator has passed floors that were never driven.
int storeys_between(const Floor& lower, const Floor& upper, double storey) {
  constexpr double kSlack = 0.2;  // of a storey: storeys of one building differ
  if (storey == 0.0) return 1;
  const double count = (upper.height_m - lower.height_m) / storey;
  const double whole = std::round(count);
  return whole >= 2.0 && std::abs(count - whole) <= kSlack ? static_cast<int>(whole) : 1;
}

}  // namespace

double storey_m(const std::vector<Floor>& floors) {
  double storey = 0.0;
  for (std::size_t i = 1; i < floors.size(); ++i) {
    const double gap_m = floors[i].height_m - floors[i - 1].height_m;
    if (gap_m >= kLowestStoreyM && gap_m <= kHighestStoreyM && (storey == 0.0 || gap_m < storey))
      storey = gap_m;
  }
  return storey;
}

void number_floors(std::vector<Floor>& floors, double start_m) {
  const auto distance = [start_m](const Floor& floor) {
    return std::max({floor.lowest_m - start_m, start_m - floor.highest_m, 0.0});
  };
  const auto zero = std::min_element(floors.begin(), floors.end(), [&](const Floor& a, const Floor& b) {
    return distance(a) < distance(b);
  });
  if (zero == floors.end()) return;
  const double storey = storey_m(floors);
  zero->number = 0;
  for (auto at = zero; at + 1 != floors.end(); ++at) {
    (at + 1)->number = at->number + storeys_between(*at, *(at + 1), storey);
  }
  for (auto at = zero; at != floors.begin(); --at) {
    (at - 1)->number = at->number - storeys_between(*(at - 1), *at, storey);
  }
}

}  // namespace isobar
