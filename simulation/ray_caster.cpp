// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ray_caster.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace isobar::simulation {

using Eigen::Vector3f;
using Lane = Eigen::Array4f;

namespace {

constexpr std::int32_t kEmpty = std::numeric_limits<std::int32_t>::min();
constexpr std::size_t kLeafSize = 4;
constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

struct Bounds {
  Vector3f low = Vector3f::Constant(std::numeric_limits<float>::max());
  Vector3f high = Vector3f::Constant(std::numeric_limits<float>::lowest());

  void grow(const Vector3f& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void grow(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] float half_area() const {
    const Vector3f size = (high - low).cwiseMax(0.0F);
    return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
  }
};

Lane load(const float (&lane)[4]) {  // NOLINT(modernize-avoid-c-arrays): layout for vector loads
  return Lane::Map(lane);
}

}  // namespace

/// Splits the triangles by the surface area heuristic in bins (Wald 2007) and flattens two levels into one.
class RayCaster::Builder {
 public:
  Builder(RayCaster& caster, const std::vector<Triangle>& triangles)
      : caster_(caster), triangles_(triangles) {
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0U);
    for (const Triangle& triangle : triangles) {
      Bounds bounds;
      bounds.grow(triangle.a);
      bounds.grow(triangle.b);
      bounds.grow(triangle.c);
      bounds_.push_back(bounds);
    }
  }

  void build() {
    Range all{0, order_.size(), {}};
    for (const Bounds& bounds : bounds_) all.bounds.grow(bounds);
    caster_.low_ = all.bounds.low;
    caster_.high_ = all.bounds.high;
    build_node(all);
  }

 private:
  struct Range {
    std::size_t begin;
    std::size_t end;
    Bounds bounds;
    [[nodiscard]] std::size_t size() const { return end - begin; }
  };

  std::int32_t build_node(const Range& range) {
    const auto self = static_cast<std::int32_t>(caster_.nodes_.size());
    caster_.nodes_.emplace_back();
    std::array<Range, 4> parts{range};
    std::size_t count = 1;
    while (count < 4) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                           [](const Range& a, const Range& b) { return weight(a) < weight(b); });
      if (largest->size() <= kLeafSize) break;
      split(*largest, parts[count]);
      ++count;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const bool used = i < count && parts[i].size() > 0;
      const std::int32_t child = !used                          ? kEmpty
                                 : parts[i].size() <= kLeafSize ? ~build_leaf(parts[i])
                                                                : build_node(parts[i]);
      Node& node = caster_.nodes_[static_cast<std::size_t>(self)];
      node.child[i] = child;
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][i] = used ? parts[i].bounds.low[axis] : std::numeric_limits<float>::max();
        node.high[axis][i] = used ? parts[i].bounds.high[axis] : std::numeric_limits<float>::lowest();
      }
    }
    return self;
  }

  static float weight(const Range& range) {
    return range.size() <= kLeafSize ? -1.0F : range.bounds.half_area();
  }

  std::int32_t build_leaf(const Range& range) {
    Leaf leaf{};
    for (std::size_t lane = 0; lane < kLeafSize; ++lane) {
      leaf.index[lane] = kNoTriangle;
      if (lane >= range.size()) continue;
      const std::uint32_t index = order_[range.begin + lane];
      const Triangle& triangle = triangles_[index];
      leaf.index[lane] = index;
      for (int axis = 0; axis < 3; ++axis) {
        leaf.corner[axis][lane] = triangle.a[axis];
        leaf.edge1[axis][lane] = triangle.b[axis] - triangle.a[axis];
        leaf.edge2[axis][lane] = triangle.c[axis] - triangle.a[axis];
      }
    }
    caster_.leaves_.push_back(leaf);
    return static_cast<std::int32_t>(caster_.leaves_.size()) - 1;
  }

  [[nodiscard]] float centre(std::uint32_t index, int axis) const {
    return 0.5F * (bounds_[index].low[axis] + bounds_[index].high[axis]);
  }

  /// Splits `range` in two: the lower half stays, the upper goes to `upper`.
  void split(Range& range, Range& upper) {
    Bounds centres;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Bounds& bounds = bounds_[order_[i]];
      centres.grow(0.5F * (bounds.low + bounds.high));
    }
    int best_axis = -1;
    float best_cost = std::numeric_limits<float>::max();
    float best_position = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [cost, position] = best_plane(range, centres, axis);
      if (cost < best_cost) {
        best_axis = axis;
        best_cost = cost;
        best_position = position;
      }
    }
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(range.end);
    auto middle = begin + (end - begin) / 2;  // all centres in one point: halve the list as it is
    if (best_axis >= 0) {
      middle = std::partition(begin, end,
                              [&](std::uint32_t index) { return centre(index, best_axis) < best_position; });
    }
    const auto at = static_cast<std::size_t>(middle - order_.begin());
    upper = make_range(at, range.end);
    range = make_range(range.begin, at);
  }

  [[nodiscard]] Range make_range(std::size_t begin, std::size_t end) const {
    Range range{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) range.bounds.grow(bounds_[order_[i]]);
    return range;
  }

  /// Cost and position of the best of 16 planes across `axis`; infinite cost where no plane separates.
  [[nodiscard]] std::pair<float, float> best_plane(const Range& range, const Bounds& centres,
                                                   int axis) const {
    constexpr int kBins = 16;
    constexpr float kInfinite = std::numeric_limits<float>::max();
    const float low = centres.low[axis];
    const float width = centres.high[axis] - low;
    if (width <= 1e-6F) return {kInfinite, 0.0F};
    std::array<Bounds, kBins> bins;
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const auto bin = static_cast<std::size_t>(
          std::clamp(static_cast<int>(kBins * (centre(order_[i], axis) - low) / width), 0, kBins - 1));
      bins[bin].grow(bounds_[order_[i]]);
      ++counts[bin];
    }
    float best_cost = kInfinite;
    float best_position = 0.0F;
    for (std::size_t plane = 1; plane < kBins; ++plane) {
      Bounds left;
      Bounds right;
      std::size_t left_count = 0;
      for (std::size_t bin = 0; bin < kBins; ++bin) {
        (bin < plane ? left : right).grow(bins[bin]);
        if (bin < plane) left_count += counts[bin];
      }
      const float position = low + width * static_cast<float>(plane) / kBins;
      const std::size_t right_count = range.size() - left_count;
      if (left_count == 0 || right_count == 0 || !separates(range, axis, position)) continue;
      const float cost = left.half_area() * static_cast<float>(left_count) +
                         right.half_area() * static_cast<float>(right_count);
      if (cost < best_cost) {
        best_cost = cost;
        best_position = position;
      }
    }
    return {best_cost, best_position};
  }

  /// Rounding may put a bin's border triangle on the other side; then a plane can leave one side empty.
  [[nodiscard]] bool separates(const Range& range, int axis, float position) const {
    bool below = false;
    bool above = false;
    for (std::size_t i = range.begin; i < range.end && !(below && above); ++i) {
      (centre(order_[i], axis) < position ? below : above) = true;
    }
    return below && above;
  }

  RayCaster& caster_;
  const std::vector<Triangle>& triangles_;
  std::vector<Bounds> bounds_;
  std::vector<std::uint32_t> order_;
};

RayCaster::RayCaster(const Mesh& mesh) {
  for (const Triangle& triangle : mesh.triangles()) {
    normals_.push_back((triangle.b - triangle.a).cross(triangle.c - triangle.a).normalized());
    surfaces_.push_back(triangle.surface);
  }
  if (!mesh.triangles().empty()) Builder(*this, mesh.triangles()).build();
}

// Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997), four triangles at once.
void RayCaster::intersect(const Leaf& leaf, const Vector3f& origin, const Vector3f& direction, float& limit_m,
                          std::uint32_t& triangle) const {
  const Lane e1x = load(leaf.edge1[0]);
  const Lane e1y = load(leaf.edge1[1]);
  const Lane e1z = load(leaf.edge1[2]);
  const Lane e2x = load(leaf.edge2[0]);
  const Lane e2y = load(leaf.edge2[1]);
  const Lane e2z = load(leaf.edge2[2]);
  const Lane px = direction.y() * e2z - direction.z() * e2y;
  const Lane py = direction.z() * e2x - direction.x() * e2z;
  const Lane pz = direction.x() * e2y - direction.y() * e2x;
  const Lane determinant = e1x * px + e1y * py + e1z * pz;
  const Lane inverse = determinant.inverse();  // infinite or NaN where parallel: the comparisons below fail
  const Lane tx = origin.x() - load(leaf.corner[0]);
  const Lane ty = origin.y() - load(leaf.corner[1]);
  const Lane tz = origin.z() - load(leaf.corner[2]);
  const Lane u = (tx * px + ty * py + tz * pz) * inverse;
  const Lane qx = ty * e1z - tz * e1y;
  const Lane qy = tz * e1x - tx * e1z;
  const Lane qz = tx * e1y - ty * e1x;
  const Lane v = (direction.x() * qx + direction.y() * qy + direction.z() * qz) * inverse;
  const Lane t = (e2x * qx + e2y * qy + e2z * qz) * inverse;
  for (int lane = 0; lane < 4; ++lane) {
    // A hair of overlap closes the seam between two triangles of one wall.
    constexpr float kSeam = 1e-6F;
    const bool inside = u[lane] >= -kSeam && v[lane] >= -kSeam && u[lane] + v[lane] <= 1.0F + kSeam;
    if (inside && t[lane] > 0.0F && t[lane] < limit_m && leaf.index[lane] != kNoTriangle) {
      limit_m = t[lane];
      triangle = leaf.index[lane];
    }
  }
}

Hit RayCaster::cast(const Vector3f& origin, const Vector3f& direction, float limit_m) const {
  Hit hit{limit_m, 0.0F, Surface::kPlaster, false};
  if (nodes_.empty()) return hit;
  std::array<float, 3> inverse{};
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float kTiny = 1e-12F;
    const float d = direction[axis];
    inverse[static_cast<std::size_t>(axis)] = 1.0F / (std::abs(d) > kTiny ? d : std::copysign(kTiny, d));
  }
  struct Entry {
    std::int32_t child;
    float near_m;
  };
  std::array<Entry, 128> stack;  // three entries a level at most: 42 levels of four children
  std::size_t depth = 0;
  stack[depth++] = {0, 0.0F};
  std::uint32_t triangle = kNoTriangle;
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.near_m >= hit.distance_m) continue;
    if (entry.child < 0) {
      const std::int32_t leaf = ~entry.child;
      intersect(leaves_[static_cast<std::size_t>(leaf)], origin, direction, hit.distance_m, triangle);
      continue;
    }
    // Slab test of Kay and Kajiya (1986) on four boxes.
    const Node& node = nodes_[static_cast<std::size_t>(entry.child)];
    Lane near = Lane::Zero();
    Lane far = Lane::Constant(hit.distance_m);
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = inverse[static_cast<std::size_t>(axis)];
      const bool forward = scale >= 0.0F;
      near = near.max((load(forward ? node.low[axis] : node.high[axis]) - origin[axis]) * scale);
      far = far.min((load(forward ? node.high[axis] : node.low[axis]) - origin[axis]) * scale);
    }
    const std::size_t first = depth;
    for (int i = 0; i < 4; ++i) {
      if (node.child[i] == kEmpty || near[i] > far[i] * 1.000002F) continue;
      std::size_t at = depth++;  // insertion sort, nearest on top
      for (; at > first && stack[at - 1].near_m < near[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {node.child[i], near[i]};
    }
  }
  if (triangle == kNoTriangle) return hit;
  hit.found = true;
  hit.cos_incidence = std::abs(normals_[triangle].dot(direction));
  hit.surface = surfaces_[triangle];
  return hit;
}

}  // namespace isobar::simulation
