// SPDX-License-Identifier: BSD-3-Clause
// Construction of the ray caster's bounding volume hierarchy.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "simulation/ray_caster.hpp"

namespace isobar::simulation {

using Eigen::Vector3f;

namespace {

/// Axis-aligned bounding box.
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
  /// Half of the surface area.
  [[nodiscard]] float half_area() const {
    const Vector3f size = (high - low).cwiseMax(0.0F);
    return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
  }
};

}  // namespace

/// Builds the hierarchy by the binned surface area heuristic (Wald, 2007); two binary levels make one with
/// four children.
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

  /// Splits `range` in two: it keeps the lower part, `upper` becomes the upper part.
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
    auto middle = begin + (end - begin) / 2;  // if all centres coincide: halve the list
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

  /// Cost and position of the best of 15 planes perpendicular to `axis`; the maximum float if none separates.
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

  /// True if there are triangles on both sides. Counts per bin do not prove it: rounding may put a triangle
  /// at the border of a bin on the other side.
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

}  // namespace isobar::simulation
