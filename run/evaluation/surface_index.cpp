// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/surface_index.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isobar::evaluation {

using Eigen::Vector3f;

namespace {

constexpr float kSurfaceCellM = 1.0F;

using SurfaceCell = Eigen::Array<std::int64_t, 3, 1>;

SurfaceCell cell_at(const Vector3f& point) {
  return (point.array() / kSurfaceCellM).floor().cast<std::int64_t>();
}

/// 21 bits an axis: 2000 km.
std::uint64_t key_of(const SurfaceCell& cell) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21U) - 1;
  const auto bits = [&](int axis) { return static_cast<std::uint64_t>(cell[axis]) & kMask; };
  return bits(0) | bits(1) << 21U | bits(2) << 42U;
}

/// Point of a triangle that is nearest to a point, by the regions of Voronoi: Ericson 2005, "Real-Time
/// Collision Detection", section 5.1.5.
Vector3f nearest_on(const files::SurfaceTriangle& triangle, const Vector3f& p) {
  const auto& [a, b, c] = triangle;
  const Vector3f ab = b - a;
  const Vector3f ac = c - a;
  const float d1 = ab.dot(p - a);
  const float d2 = ac.dot(p - a);
  if (d1 <= 0.0F && d2 <= 0.0F) return a;
  const float d3 = ab.dot(p - b);
  const float d4 = ac.dot(p - b);
  if (d3 >= 0.0F && d4 <= d3) return b;
  const float d5 = ab.dot(p - c);
  const float d6 = ac.dot(p - c);
  if (d6 >= 0.0F && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return a + d1 / (d1 - d3) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0F && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

}  // namespace

SurfaceIndex::SurfaceIndex(std::vector<files::SurfaceTriangle> triangles) : triangles_(std::move(triangles)) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> entries;
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const auto& [a, b, c] = triangles_[i];
    const Vector3f reach = Vector3f::Constant(kReachM);
    const SurfaceCell low = cell_at(a.cwiseMin(b).cwiseMin(c) - reach);
    const SurfaceCell high = cell_at(a.cwiseMax(b).cwiseMax(c) + reach);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) entries.emplace_back(key_of({x, y, z}), i);
      }
    }
  }
  std::sort(entries.begin(), entries.end());
  by_cell_.reserve(entries.size());
  for (const auto& [key, triangle] : entries) {
    Range& range =
        cells_.try_emplace(key, Range{static_cast<std::uint32_t>(by_cell_.size()), 0}).first->second;
    by_cell_.push_back(triangle);
    range.end = static_cast<std::uint32_t>(by_cell_.size());
  }
}

float SurfaceIndex::distance_m(const Vector3f& point) const {
  const auto found = cells_.find(key_of(cell_at(point)));
  if (found == cells_.end()) return kReachM;
  float nearest = kReachM;
  for (std::uint32_t i = found->second.begin; i < found->second.end; ++i) {
    nearest = std::min(nearest, (nearest_on(triangles_[by_cell_[i]], point) - point).norm());
  }
  return nearest;
}

MapFigures map_figures(const std::vector<std::array<float, 3>>& points, const SurfaceIndex& surfaces) {
  MapFigures figures;
  if (points.empty()) return figures;
  std::size_t near = 0;
  std::size_t far = 0;
  for (const std::array<float, 3>& point : points) {
    const float distance_m = surfaces.distance_m(Vector3f(point.data()));
    near += distance_m <= 0.05F ? 1 : 0;
    far += distance_m > 0.20F ? 1 : 0;
  }
  figures.within_5_cm = static_cast<double>(near) / static_cast<double>(points.size());
  figures.beyond_20_cm = static_cast<double>(far) / static_cast<double>(points.size());
  return figures;
}

}  // namespace isobar::evaluation
