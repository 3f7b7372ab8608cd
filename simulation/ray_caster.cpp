// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ray_caster.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace isobar::simulation {

using Eigen::Vector3f;
using Lane = Eigen::Array4f;

namespace {

Lane load(const float (&lane)[4]) {  // NOLINT(modernize-avoid-c-arrays): layout for vector loads
  return Lane::Map(lane);
}

}  // namespace

// Intersection with four triangles at once: Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle
// Intersection" (1997).
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
  const Lane inverse = determinant.inverse();  // infinite or NaN if parallel: no hit below
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
    // Tolerance of the barycentric coordinates: neighbouring triangles overlap, so that no ray passes between
    // them.
    constexpr float kSeam = 1e-6F;
    const bool inside = u[lane] >= -kSeam && v[lane] >= -kSeam && u[lane] + v[lane] <= 1.0F + kSeam;
    if (inside && t[lane] > 0.0F && t[lane] < limit_m && leaf.index[lane] != kNoTriangle) {
      limit_m = t[lane];
      triangle = leaf.index[lane];
    }
  }
}

std::vector<std::array<Vector3f, 3>> RayCaster::triangles() const {
  std::vector<std::array<Vector3f, 3>> all;
  for (const Leaf& leaf : leaves_) {
    for (std::size_t lane = 0; lane < kLeafSize; ++lane) {
      if (leaf.index[lane] == kNoTriangle) continue;
      const Vector3f a(leaf.corner[0][lane], leaf.corner[1][lane], leaf.corner[2][lane]);
      const Vector3f ab(leaf.edge1[0][lane], leaf.edge1[1][lane], leaf.edge1[2][lane]);
      const Vector3f ac(leaf.edge2[0][lane], leaf.edge2[1][lane], leaf.edge2[2][lane]);
      all.push_back({a, a + ab, a + ac});
    }
  }
  return all;
}

Hit RayCaster::cast(const Vector3f& origin, const Vector3f& direction, float limit_m) const {
  Hit hit{limit_m, 0.0F, Surface::kPlaster, false};
  if (nodes_.empty()) return hit;
  std::array<float, 3> inverse{};
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float kTiny = 1e-12F;  // avoids a division by zero for rays parallel to an axis
    const float d = direction[axis];
    inverse[static_cast<std::size_t>(axis)] = 1.0F / (std::abs(d) > kTiny ? d : std::copysign(kTiny, d));
  }
  struct Entry {
    std::int32_t child;
    float near_m;
  };
  std::array<Entry, 128> stack;  // at most three entries remain per level: enough for 42 levels
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
    // Slab test (Kay and Kajiya, 1986) of four boxes at once.
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
