// SPDX-License-Identifier: BSD-3-Clause
// Nearest hit of a ray on a triangle mesh, by a bounding volume hierarchy with four children per node.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "simulation/mesh.hpp"

namespace isobar::simulation {

/// Result of a ray. If nothing was hit, `distance_m` is the limit of the ray.
struct Hit {
  float distance_m = 0.0F;
  float cos_incidence = 0.0F;  ///< |cosine| between ray and surface normal, 0 (grazing) … 1
  Surface surface = Surface::kPlaster;
  bool found = false;
};

/// Immutable: cast() may be called from any number of threads.
class RayCaster {
 public:
  RayCaster() = default;
  explicit RayCaster(const Mesh& mesh);

  /// Nearest hit on the ray origin + t direction, 0 < t < limit_m; `direction`: unit vector.
  [[nodiscard]] Hit cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                         float limit_m) const;

  /// All triangles, in any order; their corners are rounded to single precision once more.
  [[nodiscard]] std::vector<std::array<Eigen::Vector3f, 3>> triangles() const;

  /// Corners of the bounding box [m].
  [[nodiscard]] Eigen::Vector3f low() const { return low_; }
  [[nodiscard]] Eigen::Vector3f high() const { return high_; }

 private:
  static constexpr std::int32_t kEmpty = std::numeric_limits<std::int32_t>::min();
  static constexpr std::size_t kLeafSize = 4;  ///< triangles per leaf: one per SIMD lane
  static constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

  /// Bounding boxes of four children, laid out for SIMD: one operation per coordinate plane.
  struct alignas(16) Node {
    float low[3][4];        // NOLINT(modernize-avoid-c-arrays): layout for vector loads
    float high[3][4];       // NOLINT(modernize-avoid-c-arrays)
    std::int32_t child[4];  // NOLINT: >= 0: node; < 0: leaf ~child; kEmpty: none
  };
  /// Four triangles, each as a corner and two edges. Unused lanes have zero edges, which no ray hits.
  struct alignas(16) Leaf {
    float corner[3][4];      // NOLINT(modernize-avoid-c-arrays)
    float edge1[3][4];       // NOLINT(modernize-avoid-c-arrays)
    float edge2[3][4];       // NOLINT(modernize-avoid-c-arrays)
    std::uint32_t index[4];  // NOLINT(modernize-avoid-c-arrays)
  };
  class Builder;

  void intersect(const Leaf& leaf, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                 float& limit_m, std::uint32_t& triangle) const;

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<Eigen::Vector3f> normals_;  ///< unit normal per triangle
  std::vector<Surface> surfaces_;         ///< per triangle
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_ = Eigen::Vector3f::Zero();
};

}  // namespace isobar::simulation
