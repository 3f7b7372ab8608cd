// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/find_floors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/floors/floor_levels.hpp"
#include "core/floors/floor_numbers.hpp"
#include "core/floors/level_drive.hpp"
#include "core/map/grid.hpp"

namespace isobar {

namespace {

constexpr double kMergedM = 0.6;      // levels this near are one floor with a step or a short ramp in it
constexpr double kEvenM = 0.6;        // range of heights of a floor in a building
constexpr double kLeastLevel = 0.6;   // share of the way that is level in a building
constexpr double kUsualDriveM = 6.0;  // after which a floor is believed by 1 - 1/e
constexpr double kUsualAreaM2 = 20.0;
constexpr double kWithoutPath = 0.6;  // nobody has shown that one can stand there
constexpr double kUnconfirmed = 0.3;  // a floor that is only assumed, where the run began

double gap_m(const FloorLevel& a, const FloorLevel& b) {
  return std::max({a.lowest_m - b.highest_m, b.lowest_m - a.highest_m, 0.0});
}

// True if the path rises or falls by a storey on a way as short as only stairs and elevators have it. Their slope is 0.5
// and more, with a landing between two flights still 0.25; hills and ramps that are driven have less.
bool has_steep_storey(const std::vector<DrivenPlace>& places, double least_storey_m) {
  constexpr double kSteep = 0.25;
  const auto most_places = static_cast<std::size_t>(least_storey_m / kSteep / DrivenPlace::kStepM);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t end = std::min(places.size(), i + most_places + 1);
    for (std::size_t j = i + 1; j < end; ++j) {
      if (std::abs(places[j].p_map.z() - places[i].p_map.z()) >= least_storey_m) return true;
    }
  }
  return false;
}

// True if some place was driven at two heights.
bool is_stacked(const std::vector<DrivenPlace>& places, double least_storey_m) {
  struct Range {
    double lowest_m;
    double highest_m;
  };
  std::map<std::pair<int, int>, Range> squares;  // of 1 m
  bool stacked = false;
  for (const DrivenPlace& place : places) {
    const double z = place.p_map.z();
    const std::pair square{floor_int(place.p_map.x()), floor_int(place.p_map.y())};
    Range& range = squares.try_emplace(square, Range{z, z}).first->second;
    range = {std::min(range.lowest_m, z), std::max(range.highest_m, z)};
    stacked = stacked || range.highest_m - range.lowest_m >= least_storey_m;
  }
  return stacked;
}

FloorLevel merged(const FloorLevel& a, const FloorLevel& b) {
  FloorLevel both;
  both.lowest_m = std::min(a.lowest_m, b.lowest_m);
  both.highest_m = std::max(a.highest_m, b.highest_m);
  both.driven_m = a.driven_m + b.driven_m;
  both.area_m2 = a.area_m2 + b.area_m2;
  const double weight_a = a.driven_m > 0.0 || b.driven_m > 0.0 ? a.driven_m : a.area_m2;
  const double weight_b = a.driven_m > 0.0 || b.driven_m > 0.0 ? b.driven_m : b.area_m2;
  both.height_m = (weight_a * a.height_m + weight_b * b.height_m) / (weight_a + weight_b);
  both.extent_m = a.extent_m.merged(b.extent_m);
  return both;
}

struct Choice {
  std::vector<FloorLevel> floors;
  std::vector<FloorLevel> others;
};

// The largest levels first; each one that is a storey from all chosen ones is a floor.
Choice choose(std::vector<FloorLevel> levels, bool has_path, const FloorConfig& config) {
  const auto size = [has_path](const FloorLevel& level) { return has_path ? level.driven_m : level.area_m2; };
  std::stable_sort(levels.begin(), levels.end(),
                   [&](const FloorLevel& a, const FloorLevel& b) { return size(a) > size(b); });
  Choice choice;
  for (const FloorLevel& level : levels) {
    const auto nearest = std::min_element(
        choice.floors.begin(), choice.floors.end(),
        [&](const FloorLevel& a, const FloorLevel& b) { return gap_m(a, level) < gap_m(b, level); });
    const bool any = nearest != choice.floors.end();
    const bool is_large =
        level.area_m2 >= config.least_area_m2 && (!has_path || level.driven_m >= config.least_drive_m);
    if (any && gap_m(*nearest, level) < kMergedM) {
      *nearest = merged(*nearest, level);
    } else if (is_large && (!any || gap_m(*nearest, level) >= config.least_storey_m)) {
      choice.floors.push_back(level);
    } else {
      choice.others.push_back(level);
    }
  }
  const auto is_below = [](const FloorLevel& a, const FloorLevel& b) { return a.height_m < b.height_m; };
  std::sort(choice.floors.begin(), choice.floors.end(), is_below);
  std::sort(choice.others.begin(), choice.others.end(), is_below);
  return choice;
}

bool is_terrain(const Choice& choice, const std::vector<DrivenPlace>& places, const FloorConfig& config) {
  double level_m = 0.0;
  for (const FloorLevel& floor : choice.floors) {
    if (floor.highest_m - floor.lowest_m <= kEvenM) level_m += floor.driven_m;
  }
  const double way_m = DrivenPlace::kStepM * static_cast<double>(places.size());
  return way_m >= config.least_drive_m && level_m < kLeastLevel * way_m;
}

// The path until it leaves the height of its first place.
std::vector<DrivenPlace> start_of(const std::vector<DrivenPlace>& places) {
  const double start_m = places.front().p_map.z();
  const auto leaves = std::find_if(places.begin(), places.end(), [start_m](const DrivenPlace& place) {
    return std::abs(place.p_map.z() - start_m) > 0.5 * kEvenM;
  });
  return {places.begin(), leaves};
}

// All heights of a path as one level, whatever their slopes.
FloorLevel one_level(const std::vector<DrivenPlace>& places, double base_height_m) {
  FloorLevel level;
  level.lowest_m = level.highest_m = places.front().p_map.z() - base_height_m;
  level.driven_m = DrivenPlace::kStepM * static_cast<double>(places.size() - 1);
  for (const DrivenPlace& place : places) {
    const double ground_m = place.p_map.z() - base_height_m;
    level.lowest_m = std::min(level.lowest_m, ground_m);
    level.highest_m = std::max(level.highest_m, ground_m);
    level.height_m += ground_m / static_cast<double>(places.size());
  }
  return level;
}

double certainty_of(const FloorLevel& level, bool has_path) {
  const double by_area = 1.0 - std::exp(-level.area_m2 / kUsualAreaM2);
  const double by_drive = has_path ? 1.0 - std::exp(-level.driven_m / kUsualDriveM) : kWithoutPath;
  return by_area * by_drive;
}

Floor floor_of(const FloorLevel& level, bool has_path) {
  Floor floor;
  floor.height_m = level.height_m;
  floor.lowest_m = level.lowest_m;
  floor.highest_m = level.highest_m;
  floor.extent_m = level.extent_m;
  floor.area_m2 = level.area_m2;
  floor.driven_m = level.driven_m;
  floor.certainty = certainty_of(level, has_path);
  return floor;
}

}  // namespace

Floors find_floors(const GroundColumns& ground, std::span<const Eigen::Vector3d> path,
                   const FloorConfig& config) {
  const std::vector<DrivenPlace> places = driven_places(path, config.most_level_slope);
  const bool has_path = !places.empty();
  Floors result;
  result.base_height_m = height_above_ground_m(ground, places);
  std::vector<FloorLevel> levels = has_path ? levels_of_drive(places, result.base_height_m)
                                            : levels_of_ground(ground, config.least_storey_m);
  measure_ground(ground, levels);
  Choice choice = choose(std::move(levels), has_path, config);
  const bool building =
      is_stacked(places, config.least_storey_m) || has_steep_storey(places, config.least_storey_m);
  const bool terrain = has_path && !building && is_terrain(choice, places, config);
  const bool assumed = has_path && choice.floors.empty();
  if (terrain || assumed) {
    choice = {{one_level(building ? start_of(places) : places, result.base_height_m)}, {}};
  }
  measure_ground(ground, choice.floors);
  for (const FloorLevel& level : choice.floors) {
    Floor& floor = result.floors.emplace_back(floor_of(level, has_path));
    floor.is_terrain = terrain;
    if (assumed) floor.certainty = std::max(floor.certainty, kUnconfirmed);
  }
  for (const FloorLevel& level : choice.others) {
    result.half_levels.push_back({level.height_m, level.driven_m, level.area_m2});
  }
  if (has_path) result.start_m = places.front().p_map.z() - result.base_height_m;
  number_floors(result.floors, result.start_m);
  return result;
}

}  // namespace isobar
