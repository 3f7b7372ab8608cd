// SPDX-License-Identifier: BSD-3-Clause
#include "tools/true_floors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "run/evaluation/segments.hpp"

namespace isobar::tools {

namespace {

constexpr double kLevelM = 1.0;    // heights of one floor are closer together
constexpr double kOnFloorM = 0.2;  // from its height

/// Means of heights without a gap, ascending.
std::vector<double> levels_of(std::vector<double> heights) {
  std::sort(heights.begin(), heights.end());
  std::vector<double> levels;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    sum += heights[i];
    ++count;
    if (i + 1 < heights.size() && heights[i + 1] - heights[i] < kLevelM) continue;
    levels.push_back(sum / static_cast<double>(count));
    sum = 0.0;
    count = 0;
  }
  return levels;
}

}  // namespace

TrueFloors::TrueFloors(const evaluation::ReferenceData& reference)
    : flat_(evaluation::flat_segments(reference.segments)) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < reference.trajectory.poses.size(); i += 10) {
    const evaluation::StampedPose& pose = reference.trajectory.poses[i];
    if (is_flat(pose.stamp_ns)) heights.push_back(pose.position_m.z());
  }
  levels_m_ = levels_of(std::move(heights));
  for (const evaluation::StampedPose& pose : reference.trajectory.poses) {
    if (const std::optional<int> level = level_of(pose)) {
      first_ = *level;
      break;
    }
  }
}

bool TrueFloors::is_flat(std::int64_t stamp_ns) const {
  const auto after =
      std::upper_bound(flat_.begin(), flat_.end(), stamp_ns,
                       [](std::int64_t stamp, const auto& segment) { return stamp < segment.start_ns; });
  return after != flat_.begin() && std::prev(after)->contains(stamp_ns);
}

std::optional<int> TrueFloors::level_of(const evaluation::StampedPose& pose) const {
  if (!is_flat(pose.stamp_ns)) return std::nullopt;
  for (std::size_t i = 0; i < levels_m_.size(); ++i) {
    if (std::abs(levels_m_[i] - pose.position_m.z()) < kOnFloorM) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::optional<int> TrueFloors::number_at(const evaluation::StampedPose& pose) const {
  const std::optional<int> level = level_of(pose);
  if (!level) return std::nullopt;
  return *level - first_;
}

}  // namespace isobar::tools
