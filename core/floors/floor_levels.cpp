// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/floor_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/map/grid.hpp"

namespace isobar {

namespace {

constexpr double kLevelGapM = 0.3;   // heights farther apart are of two levels
constexpr double kNearLevelM = 0.2;  // ground this far beyond the driven heights is of the level
constexpr double kBinM = 0.1;        // of the histogram of ground
constexpr int kBinsAround = 2;       // that belong to a peak, on either side
constexpr double kLeastPeak = 0.2;   // share of the largest peak that makes a level
constexpr double kMostBaseHeightM = 2.0;
constexpr double kColumnM2 = GroundColumns::kColumnM * GroundColumns::kColumnM;
constexpr std::size_t kMostBins = 100'000;  // 10 km

// The ground nearest below a place of the path, within reach of a robot's height.
std::optional<double> ground_below(const GroundColumns& ground, const Eigen::Vector3d& p_map) {
  constexpr double kAboveM = 0.15;  // noise of the path: the ground may be above base_link
  std::optional<double> best;
  for (const GroundColumns::Surface& surface : ground.at(GroundColumns::column_of(p_map))) {
    const auto height_m = static_cast<double>(surface.height_m);
    if (height_m > p_map.z() - kMostBaseHeightM && height_m < p_map.z() + kAboveM) best = height_m;
  }
  return best;
}

Eigen::AlignedBox2d box_of(const ColumnIndex& column) {
  const Eigen::Vector2d corner = Eigen::Vector2d(column.x, column.y) * GroundColumns::kColumnM;
  return {corner, corner.array() + GroundColumns::kColumnM};
}

// Area of ground by height, from the lowest one.
struct Histogram {
  std::int32_t first = 0;
  std::vector<double> area_m2;
};

Histogram histogram_of(const GroundColumns& ground) {
  Histogram histogram;
  std::int32_t last = 0;
  bool any = false;
  for (const GroundColumns::Surface& surface : ground.surfaces()) {
    const std::int32_t bin = floor_int(static_cast<double>(surface.height_m) / kBinM);
    histogram.first = any ? std::min(histogram.first, bin) : bin;
    last = any ? std::max(last, bin) : bin;
    any = true;
  }
  if (!any) return histogram;
  histogram.area_m2.resize(std::min(static_cast<std::size_t>(last - histogram.first) + 1, kMostBins));
  for (const GroundColumns::Surface& surface : ground.surfaces()) {
    if (surface.count < GroundColumns::kLeastPoints) continue;
    const auto bin =
        static_cast<std::size_t>(floor_int(static_cast<double>(surface.height_m) / kBinM) - histogram.first);
    if (bin < histogram.area_m2.size()) histogram.area_m2[bin] += kColumnM2;
  }
  return histogram;
}

// The level around the bin with the most ground.
FloorLevel peak_at(const Histogram& histogram, std::size_t bin) {
  FloorLevel level;
  const auto around = static_cast<std::size_t>(kBinsAround);
  const std::size_t last = std::min(bin + around + 1, histogram.area_m2.size());
  double moment = 0.0;
  for (std::size_t i = bin - std::min(bin, around); i < last; ++i) {
    level.area_m2 += histogram.area_m2[i];
    moment += histogram.area_m2[i] * (static_cast<double>(i) + histogram.first + 0.5) * kBinM;
  }
  level.height_m = level.area_m2 > 0.0 ? moment / level.area_m2 : 0.0;
  level.lowest_m = level.height_m;
  level.highest_m = level.height_m;
  return level;
}

}  // namespace

double height_above_ground_m(const GroundColumns& ground, std::span<const DrivenPlace> places) {
  std::vector<double> heights;
  for (const DrivenPlace& place : places) {
    const std::optional<double> below = ground_below(ground, place.p_map);
    if (below) heights.push_back(place.p_map.z() - *below);
  }
  if (heights.empty()) return 0.0;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

std::vector<FloorLevel> levels_of_drive(std::span<const DrivenPlace> places, double base_height_m) {
  std::vector<double> heights;
  for (const DrivenPlace& place : places) {
    if (place.is_level) heights.push_back(place.p_map.z() - base_height_m);
  }
  std::sort(heights.begin(), heights.end());
  std::vector<FloorLevel> levels;
  std::size_t count = 0;
  for (const double height_m : heights) {
    if (levels.empty() || height_m - levels.back().highest_m > kLevelGapM) {
      levels.push_back({});
      levels.back().lowest_m = height_m;
      count = 0;
    }
    FloorLevel& level = levels.back();
    level.highest_m = height_m;
    level.driven_m += DrivenPlace::kStepM;
    level.height_m += (height_m - level.height_m) / static_cast<double>(++count);
  }
  return levels;
}

std::vector<FloorLevel> levels_of_ground(const GroundColumns& ground, double least_gap_m) {
  Histogram histogram = histogram_of(ground);
  std::vector<FloorLevel> levels;
  const auto gap = static_cast<std::ptrdiff_t>(std::ceil(least_gap_m / kBinM));
  while (!histogram.area_m2.empty()) {
    const auto most = std::max_element(histogram.area_m2.begin(), histogram.area_m2.end());
    const std::ptrdiff_t bin = most - histogram.area_m2.begin();
    const FloorLevel level = peak_at(histogram, static_cast<std::size_t>(bin));
    if (level.area_m2 <= 0.0 || (!levels.empty() && level.area_m2 < kLeastPeak * levels.front().area_m2))
      break;
    levels.push_back(level);
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(bin - gap, 0);
    const std::ptrdiff_t last = std::min(bin + gap, static_cast<std::ptrdiff_t>(histogram.area_m2.size()));
    std::fill(histogram.area_m2.begin() + first, histogram.area_m2.begin() + last, 0.0);
  }
  const auto is_below = [](const FloorLevel& a, const FloorLevel& b) { return a.height_m < b.height_m; };
  std::sort(levels.begin(), levels.end(), is_below);
  return levels;
}

void measure_ground(const GroundColumns& ground, std::span<FloorLevel> levels) {
  for (FloorLevel& level : levels) {
    level.area_m2 = 0.0;
    level.extent_m.setEmpty();
    for (const GroundColumns::Surface& surface : ground.surfaces()) {
      const auto height_m = static_cast<double>(surface.height_m);
      if (surface.count < GroundColumns::kLeastPoints || height_m < level.lowest_m - kNearLevelM ||
          height_m > level.highest_m + kNearLevelM) {
        continue;
      }
      level.area_m2 += kColumnM2;
      level.extent_m.extend(box_of(surface.column));
    }
  }
}

}  // namespace isobar
