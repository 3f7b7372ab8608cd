// SPDX-License-Identifier: BSD-3-Clause
// Triangle mesh of a world.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace isobar::simulation {

/// Material of a surface: determines its reflectivity.
enum class Surface : std::uint8_t { kPlaster, kConcrete, kWood, kMetal, kCloth, kIce };

struct Triangle {
  Eigen::Vector3f a;
  Eigen::Vector3f b;
  Eigen::Vector3f c;
  Surface surface = Surface::kPlaster;
};

/// Unordered triangles, with builders for simple shapes. Coordinates in metres; triangles are visible from
/// both sides.
class Mesh {
 public:
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                Surface surface);
  /// Planar quadrilateral with consecutive corners a, b, c, d.
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
            const Eigen::Vector3d& d, Surface surface);
  /// Axis-aligned box between two opposite corners.
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Surface surface);
  /// Vertical prism over a regular polygon, with both caps.
  void prism(const Eigen::Vector3d& base_centre, double radius_m, double height_m, int sides,
             Surface surface);
  void append(const Mesh& other);

  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  std::vector<Triangle> triangles_;
};

}  // namespace isobar::simulation
