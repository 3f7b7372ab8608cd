// SPDX-License-Identifier: BSD-3-Clause
// Local frame of objects along a street, with builders for surfaces in it.
#pragma once

#include <Eigen/Core>

#include "simulation/mesh.hpp"

namespace isobar::simulation {

/// Coordinates [m]: u along a line, d horizontally away from it (towards the street), z up. Vertical lines
/// stay vertical; the u axis may be inclined.
struct CityFrame {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  Eigen::Vector2d out = Eigen::Vector2d::UnitY();
  double rise = 0.0;  ///< slope of the u axis, rise over run

  /// Point in plan, in the world frame [m].
  [[nodiscard]] Eigen::Vector2d plan(double u, double d) const {
    return origin_m.head<2>() + u * along + d * out;
  }
  [[nodiscard]] Eigen::Vector3d at(double u, double d, double z) const {
    const Eigen::Vector2d xy = plan(u, d);
    return {xy.x(), xy.y(), origin_m.z() + rise * u + z};
  }

  /// Vertical surface along u, at d.
  void panel(Mesh& mesh, double u0, double u1, double d, double z0, double z1, Surface surface) const {
    if (u1 <= u0 || z1 <= z0) return;
    mesh.quad(at(u0, d, z0), at(u1, d, z0), at(u1, d, z1), at(u0, d, z1), surface);
  }
  /// Vertical surface along d, at u.
  void flank(Mesh& mesh, double u, double d0, double d1, double z0, double z1, Surface surface) const {
    mesh.quad(at(u, d0, z0), at(u, d1, z0), at(u, d1, z1), at(u, d0, z1), surface);
  }
  /// Horizontal surface at z, inclined only by `rise`.
  void slab(Mesh& mesh, double u0, double u1, double d0, double d1, double z, Surface surface) const {
    mesh.quad(at(u0, d0, z), at(u1, d0, z), at(u1, d1, z), at(u0, d1, z), surface);
  }
  void box(Mesh& mesh, double u0, double u1, double d0, double d1, double z0, double z1,
           Surface surface) const {
    panel(mesh, u0, u1, d0, z0, z1, surface);
    panel(mesh, u0, u1, d1, z0, z1, surface);
    flank(mesh, u0, d0, d1, z0, z1, surface);
    flank(mesh, u1, d0, d1, z0, z1, surface);
    slab(mesh, u0, u1, d0, d1, z0, surface);
    slab(mesh, u0, u1, d0, d1, z1, surface);
  }
};

}  // namespace isobar::simulation
