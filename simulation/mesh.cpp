// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/mesh.hpp"

#include <cmath>
#include <numbers>

namespace isobar::simulation {

using Eigen::Vector3d;

void Mesh::triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, Surface surface) {
  triangles_.push_back({a.cast<float>(), b.cast<float>(), c.cast<float>(), surface});
}

void Mesh::quad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, Surface surface) {
  triangle(a, b, c, surface);
  triangle(a, c, d, surface);
}

void Mesh::box(const Vector3d& low, const Vector3d& high, Surface surface) {
  const auto corner = [&](int x, int y, int z) {
    return Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0), surface);
  quad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1), surface);
  quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1), surface);
  quad(corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1), surface);
  quad(corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1), surface);
  quad(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1), surface);
}

void Mesh::prism(const Vector3d& base_centre, double radius_m, double height_m, int sides, Surface surface) {
  const Vector3d up(0.0, 0.0, height_m);
  const auto corner = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    return Vector3d(base_centre + radius_m * Vector3d(std::cos(angle), std::sin(angle), 0.0));
  };
  for (int i = 0; i < sides; ++i) {
    const Vector3d p = corner(i);
    const Vector3d q = corner(i + 1);
    quad(p, q, q + up, p + up, surface);
    triangle(base_centre, p, q, surface);
    triangle(base_centre + up, p + up, q + up, surface);
  }
}

void Mesh::append(const Mesh& other) {
  triangles_.insert(triangles_.end(), other.triangles_.begin(), other.triangles_.end());
}

}  // namespace isobar::simulation
