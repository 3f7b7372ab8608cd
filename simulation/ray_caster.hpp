// SPDX-License-Identifier: BSD-3-Clause
// Nearest hit of a ray among triangles, by a bounding volume hierarchy with four children a node.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "simulation/mesh.hpp"

namespace isobar::simulation {

/// Where a ray ended. `distance_m` keeps its starting value where nothing was hit.
struct Hit {
  float distance_m = 0.0F;
  float cos_incidence = 0.0F;  ///< |cosine| between ray and surface normal, 0 (grazing) … 1
  Surface surface = Surface::kPlaster;
  bool found = false;
};

/// Immutable after construction; cast() may be called from any number of threads.
class RayCaster {
 public:
  RayCaster() = default;
  explicit RayCaster(const Mesh& mesh);

  /// Nearest triangle along origin + t direction, 0 < t < limit_m. `direction` is a unit vector.
  [[nodiscard]] Hit cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                         float limit_m) const;

  [[nodiscard]] Eigen::Vector3f low() const { return low_; }
  [[nodiscard]] Eigen::Vector3f high() const { return high_; }

 private:
  /// Boxes of four children, side by side for one vector operation a plane.
  struct alignas(16) Node {
    float low[3][4];        // NOLINT(modernize-avoid-c-arrays): layout for vector loads
    float high[3][4];       // NOLINT(modernize-avoid-c-arrays)
    std::int32_t child[4];  // NOLINT: >= 0 node, < 0 leaf ~child, kEmpty none
  };
  /// Four triangles as corner and two edges; unused lanes have zero edges and are never hit.
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
  std::vector<Eigen::Vector3f> normals_;  ///< unit, a triangle
  std::vector<Surface> surfaces_;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_ = Eigen::Vector3f::Zero();
};

}  // namespace isobar::simulation
