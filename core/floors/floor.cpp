// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isobar {

namespace {

constexpr double kFloorSigmaM = 0.15;     // unevenness of a floor and drift of the map's height on it
constexpr double kBetweenPerM = 0.05;     // density of being on no floor, against 1 for being on a given one
constexpr double kBesideM = 5.0;          // the map ends about this far beyond what was driven
constexpr double kBesideWeight = 0.3;     // of a floor that is not known at this place in plan
constexpr double kPerRootTwoPi = 0.3989;  // 1 / sqrt(2 pi)

constexpr double kProvisional = 0.6;  // most certainty of a floor that is not driven enough yet

constexpr double kHalfLevelM = 0.4;  // to its height

double distance_m(const Floor& floor, double ground_m) {
  return std::max({floor.lowest_m - ground_m, ground_m - floor.highest_m, 0.0});
}

/// @param on_any probability of being on any floor
FloorPlace place_of(const Floors& floors, double ground_m, double certainty, double on_any) {
  if (certainty >= 0.5) return FloorPlace::kOnFloor;
  if (on_any >= 0.5) return FloorPlace::kUnknown;
  // A level that lies a storey from all floors is one that is not driven enough yet.
  const bool is_near = std::any_of(
      floors.floors.begin(), floors.floors.end(),
      [ground_m](const Floor& floor) { return distance_m(floor, ground_m) < FloorConfig().least_storey_m; });
  const bool on_half_level = std::any_of(
      floors.half_levels.begin(), floors.half_levels.end(),
      [ground_m](const HalfLevel& level) { return std::abs(level.height_m - ground_m) < kHalfLevelM; });
  return is_near && on_half_level ? FloorPlace::kHalfLevel : FloorPlace::kBetween;
}

}  // namespace

const Floor* Floors::find(int number) const {
  const auto at = std::find_if(floors.begin(), floors.end(),
                               [number](const Floor& floor) { return floor.number == number; });
  return at != floors.end() ? &*at : nullptr;
}

Floors::Slab Floors::slab_of(const Floor& floor) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (floor.is_terrain) return {-kInfinity, kInfinity};
  Slab slab{floor.lowest_m - kReachM, floor.highest_m + kReachM};
  for (const Floor& other : floors) {
    if (other.height_m < floor.height_m) {
      slab.lowest_m = std::max(slab.lowest_m, 0.5 * (other.highest_m + floor.lowest_m));
    }
    if (other.height_m > floor.height_m) {
      slab.highest_m = std::min(slab.highest_m, 0.5 * (other.lowest_m + floor.highest_m));
    }
  }
  return slab;
}

// Bayes' rule over the floors and the hypothesis of being between them, whose density is uniform in height.
FloorGuess floor_at(const Floors& floors, const Eigen::Vector3d& p_map_base, double sigma_m) {
  const double ground_m = p_map_base.z() - floors.base_height_m;
  const double s = std::hypot(std::max(sigma_m, 0.0), kFloorSigmaM);
  FloorGuess guess;
  double best = -1.0;
  double sum = kBetweenPerM;
  for (const Floor& floor : floors.floors) {
    const double d = distance_m(floor, ground_m) / s;
    const bool inside = floor.extent_m.exteriorDistance(p_map_base.head<2>()) < kBesideM;
    const double weight = (inside ? 1.0 : kBesideWeight) * kPerRootTwoPi * std::exp(-0.5 * d * d) / s;
    // Far from every floor all densities vanish: then the nearest one is named.
    const double rank = weight > 0.0 ? weight : -d;
    sum += weight;
    if (guess.floor == nullptr || rank > best) {
      best = rank;
      guess.floor = &floor;
    }
  }
  const bool usable = guess.floor != nullptr && std::isfinite(ground_m) && std::isfinite(s);
  guess.certainty = usable ? std::max(best, 0.0) / sum : 0.0;
  if (usable && guess.floor->is_provisional) guess.certainty = std::min(guess.certainty, kProvisional);
  if (usable) guess.place = place_of(floors, ground_m, guess.certainty, 1.0 - kBetweenPerM / sum);
  return guess;
}

}  // namespace isobar
