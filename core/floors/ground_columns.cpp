// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/ground_columns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/map/grid.hpp"

namespace isobar {

namespace {

constexpr float kSameSurfaceM = 0.12F;  // points of a column closer than this are of one surface
constexpr float kThinM = 0.45F;         // below a surface; an object on the ground is drawn by its sides
constexpr std::uint32_t kLarger = 2;    // times the points
constexpr std::size_t kMostPending = std::size_t{1} << 20;
constexpr double kFarthestM = 1e8;

bool is_before(const GroundColumns::Surface& a, const GroundColumns::Surface& b) {
  return a.column != b.column ? a.column < b.column : a.height_m < b.height_m;
}

}  // namespace

ColumnIndex GroundColumns::column_of(const Eigen::Vector3d& p_map) {
  return {floor_int(p_map.x() / kColumnM), floor_int(p_map.y() / kColumnM)};
}

void GroundColumns::add(std::span<const MapPoint> points) {
  for (const MapPoint& point : points) {
    if (!is_upward(point) || !point.p_map.allFinite()) continue;
    if (point.p_map.cwiseAbs().maxCoeff() >= kFarthestM) continue;
    pending_.push_back({column_of(point.p_map), static_cast<float>(point.p_map.z()), 1});
  }
  if (pending_.size() > kMostPending) compress();
}

// Points of one column are merged upwards as long as the next one is near the mean so far.
void GroundColumns::compress() {
  if (pending_.empty()) return;
  std::sort(pending_.begin(), pending_.end(), is_before);
  std::vector<Surface> all(surfaces_.size() + pending_.size());
  std::merge(surfaces_.begin(), surfaces_.end(), pending_.begin(), pending_.end(), all.begin(), is_before);
  surfaces_.clear();
  for (const Surface& next : all) {
    if (!surfaces_.empty() && surfaces_.back().column == next.column &&
        next.height_m - surfaces_.back().height_m < kSameSurfaceM) {
      Surface& last = surfaces_.back();
      const auto share = static_cast<float>(next.count) / static_cast<float>(last.count + next.count);
      last.height_m += share * (next.height_m - last.height_m);
      last.count += next.count;
    } else {
      surfaces_.push_back(next);
    }
  }
  pending_.clear();
  pending_.shrink_to_fit();
}

void GroundColumns::finish() {
  compress();
  std::vector<Surface> kept;
  kept.reserve(surfaces_.size());
  for (auto at = surfaces_.begin(); at != surfaces_.end(); ++at) {
    bool covered = false;
    for (auto above = at + 1; above != surfaces_.end() && above->column == at->column; ++above) {
      if (above->height_m - at->height_m > kThinM) break;
      covered = covered || above->count >= kLarger * at->count;
    }
    if (!covered) kept.push_back(*at);
  }
  surfaces_ = std::move(kept);
}

std::span<const GroundColumns::Surface> GroundColumns::at(const ColumnIndex& column) const {
  const auto by_column = [](const Surface& a, const Surface& b) { return a.column < b.column; };
  const auto [first, last] =
      std::equal_range(surfaces_.begin(), surfaces_.end(), Surface{column, 0.0F, 0}, by_column);
  return {first, last};
}

}  // namespace isobar
