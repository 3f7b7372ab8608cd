// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/ground_growth.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

namespace {

// Accepted difference of height between columns d apart: a ramp of 25 % (14 degrees), and the unevenness of ground.
// Stairs have 50 to 70 %.
constexpr float kRampSlope = 0.25F;
constexpr float kUnevenM = 0.05F;
constexpr float kMostStepM = 0.13F;   // also over a gap: steps of stairs are 0.15 … 0.2 m
constexpr int kReachColumns = 2;      // gaps of one column are crossed
constexpr float kAtPathM = 0.15F;     // the path's height against the map's
constexpr int kFootprintColumns = 1;  // 0.25 … 0.5 m around the path
constexpr double kAtLevelM = 0.1;     // ground this near to the driven heights is ground, connected or not

std::uint64_t key_of(const ColumnIndex& column) {
  return std::uint64_t{static_cast<std::uint32_t>(column.x)} << 32U | static_cast<std::uint32_t>(column.y);
}

}  // namespace

GroundGrowth::GroundGrowth(const GroundColumns& columns, const Floor& floor, const Floors::Slab& within)
    : columns_(columns), floor_(floor), within_(within) {
  if (!floor.is_terrain) propose_level_ground();
}

void GroundGrowth::propose_level_ground() {
  for (const GroundColumns::Surface& surface : columns_.surfaces()) {
    const auto height_m = static_cast<double>(surface.height_m);
    if (surface.count >= GroundColumns::kLeastPoints && height_m >= floor_.lowest_m - kAtLevelM &&
        height_m <= floor_.highest_m + kAtLevelM) {
      propose(surface.column, surface.height_m);
    }
  }
}

void GroundGrowth::propose(const ColumnIndex& column, float height_m) {
  const auto height = static_cast<double>(height_m);
  if (!within_.contains(height)) return;
  const double off_m = std::max({floor_.lowest_m - height, height - floor_.highest_m, 0.0});
  candidates_.push({static_cast<float>(off_m), order_++, {column, height_m}});
}

// The map need not hold ground below the robot: the lidar does not see it there.
void GroundGrowth::add_driven(const Eigen::Vector3d& p_ground_map) {
  const ColumnIndex centre = GroundColumns::column_of(p_ground_map);
  if (centre == last_driven_) return;
  last_driven_ = centre;
  const auto driven_m = static_cast<float>(p_ground_map.z());
  for (int dy = -kFootprintColumns; dy <= kFootprintColumns; ++dy) {
    for (int dx = -kFootprintColumns; dx <= kFootprintColumns; ++dx) {
      const ColumnIndex column{centre.x + dx, centre.y + dy};
      float height_m = driven_m;
      float nearest_m = kAtPathM;
      for (const GroundColumns::Surface& surface : columns_.at(column)) {
        const float off_m = std::abs(surface.height_m - driven_m);
        if (off_m >= nearest_m) continue;
        nearest_m = off_m;
        height_m = surface.height_m;
      }
      propose(column, height_m);
    }
  }
}

bool GroundGrowth::take(const ColumnIndex& column) { return taken_.insert(key_of(column)).second; }

void GroundGrowth::propose_around(const Reached& from) {
  for (int dy = -kReachColumns; dy <= kReachColumns; ++dy) {
    for (int dx = -kReachColumns; dx <= kReachColumns; ++dx) {
      const ColumnIndex column{from.column.x + dx, from.column.y + dy};
      if (taken_.contains(key_of(column))) continue;
      const float way_m = std::hypot(static_cast<float>(dx), static_cast<float>(dy)) *
                          static_cast<float>(GroundColumns::kColumnM);
      for (const GroundColumns::Surface& surface : columns_.at(column)) {
        if (std::abs(surface.height_m - from.height_m) <=
            std::min(kUnevenM + kRampSlope * way_m, kMostStepM)) {
          propose(column, surface.height_m);
        }
      }
    }
  }
}

std::vector<GroundGrowth::Reached> GroundGrowth::grow() {
  std::vector<Reached> reached;
  while (!candidates_.empty()) {
    const Reached at = candidates_.top().at;
    candidates_.pop();
    if (!take(at.column)) continue;
    reached.push_back(at);
    propose_around(at);
  }
  return reached;
}

}  // namespace isobar
