// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/level_drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace isobar {

namespace {

constexpr std::size_t kHalfWindow = 8;  // places: slopes are taken over 4 m, since heights scatter by 3 cm
constexpr std::size_t kLeastPlaces = 6;
constexpr double kJumpM = 0.5;   // in height between two places: an elevator
constexpr double kStepsM = 0.2;  // range of heights of a level window; steps have more

// Slope by least squares over the places first … last - 1, whose ways are equal.
bool is_level_around(std::span<const DrivenPlace> places, double most_slope) {
  if (places.size() < kLeastPlaces) return false;
  const double middle = 0.5 * static_cast<double>(places.size() - 1);
  double weight = 0.0;
  double moment = 0.0;
  double lowest = places.front().p_map.z();
  double highest = lowest;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double way_m = (static_cast<double>(i) - middle) * DrivenPlace::kStepM;
    const double z = places[i].p_map.z();
    weight += way_m * way_m;
    moment += way_m * z;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  return std::abs(moment / weight) <= most_slope && highest - lowest <= kStepsM;
}

// Judges the places of one stretch without a jump.
void judge(std::span<DrivenPlace> stretch, double most_slope) {
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    const std::size_t first = i - std::min(i, kHalfWindow);
    const std::size_t last = std::min(i + kHalfWindow + 1, stretch.size());
    stretch[i].is_level = is_level_around(stretch.subspan(first, last - first), most_slope);
  }
}

}  // namespace

std::vector<DrivenPlace> driven_places(std::span<const Eigen::Vector3d> path, double most_slope) {
  std::vector<DrivenPlace> places;
  const Eigen::Vector3d* newest = nullptr;
  for (const Eigen::Vector3d& p_map : path) {
    if (!p_map.allFinite()) continue;
    newest = &p_map;
    if (places.empty() || (p_map - places.back().p_map).head<2>().norm() >= DrivenPlace::kStepM) {
      places.push_back({p_map, false});
    }
  }
  if (newest != nullptr && *newest != places.back().p_map) places.push_back({*newest, false});
  std::size_t first = 0;
  for (std::size_t i = 1; i <= places.size(); ++i) {
    const bool ends = i == places.size() || std::abs(places[i].p_map.z() - places[i - 1].p_map.z()) > kJumpM;
    if (!ends) continue;
    judge(std::span(places).subspan(first, i - first), most_slope);
    first = i;
  }
  return places;
}

}  // namespace isobar
