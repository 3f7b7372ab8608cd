// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/floors.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::evaluation {

namespace {

/// Sums over one flat segment.
struct Visit {
  double reference_sum_m = 0.0;
  double error_sum_m = 0.0;
  std::size_t poses = 0;

  [[nodiscard]] double reference_m() const { return reference_sum_m / static_cast<double>(poses); }
  [[nodiscard]] double error_m() const { return error_sum_m / static_cast<double>(poses); }
};

std::vector<Visit> visits_by_height(const std::vector<PosePair>& pairs, const std::vector<Segment>& flat) {
  std::vector<Visit> visits;
  for (const Segment& segment : flat) {
    Visit visit;
    for (const PosePair& pair : pairs) {
      if (!segment.contains(pair.stamp_ns)) continue;
      visit.reference_sum_m += pair.reference.position_m.z();
      visit.error_sum_m += pair.estimate.position_m.z() - pair.reference.position_m.z();
      ++visit.poses;
    }
    if (visit.poses > 0) visits.push_back(visit);
  }
  std::sort(visits.begin(), visits.end(),
            [](const Visit& a, const Visit& b) { return a.reference_m() < b.reference_m(); });
  return visits;
}

/// Floor of visits [begin, end).
FloorHeight floor_of(const std::vector<Visit>& visits, std::size_t begin, std::size_t end) {
  Visit all;
  FloorHeight floor;
  for (std::size_t i = begin; i < end; ++i) {
    all.reference_sum_m += visits[i].reference_sum_m;
    all.error_sum_m += visits[i].error_sum_m;
    all.poses += visits[i].poses;
    if (std::abs(visits[i].error_m()) > std::abs(floor.worst_error_m))
      floor.worst_error_m = visits[i].error_m();
  }
  floor.reference_m = all.reference_m();
  floor.mean_error_m = all.error_m();
  floor.visits = end - begin;
  return floor;
}

}  // namespace

std::vector<FloorHeight> floor_heights(const std::vector<PosePair>& pairs, const std::vector<Segment>& flat,
                                       double floor_gap_m) {
  const std::vector<Visit> visits = visits_by_height(pairs, flat);
  std::vector<FloorHeight> floors;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= visits.size(); ++i) {
    const bool parts =
        i == visits.size() || visits[i].reference_m() - visits[i - 1].reference_m() > floor_gap_m;
    if (!parts) continue;
    floors.push_back(floor_of(visits, begin, i));
    begin = i;
  }
  return floors;
}

}  // namespace isobar::evaluation
