// SPDX-License-Identifier: BSD-3-Clause
// Synthetic maps: points on rectangles, as the tiles of a map give them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "core/map/map_point.hpp"

namespace isobar::test {

/// Surfaces and the path of a robot whose base_link is on the ground.
class Scene {
 public:
  static constexpr double kSpacingM = 0.09;  // a third of a map's cell

  explicit Scene(double noise_m = 0.0) : noise_m_(noise_m) {}

  /// A parallelogram; it faces u x v.
  void add(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const Eigen::Vector3d normal = u.cross(v).normalized();
    const int columns = static_cast<int>(std::ceil(u.norm() / kSpacingM));
    const int rows = static_cast<int>(std::ceil(v.norm() / kSpacingM));
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const Eigen::Vector3d p = corner + (i + 0.5) / columns * u + (j + 0.5) / rows * v + noise() * normal;
        points.push_back({p, normal.cast<float>(), 100});
      }
    }
  }
  /// A level floor x0 … x1, y0 … y1.
  void add_ground(double x0, double y0, double x1, double y1, double z) {
    add({x0, y0, z}, {x1 - x0, 0.0, 0.0}, {0.0, y1 - y0, 0.0});
  }
  /// A ceiling, seen from below.
  void add_ceiling(double x0, double y0, double x1, double y1, double z) {
    add({x0, y0, z}, {0.0, y1 - y0, 0.0}, {x1 - x0, 0.0, 0.0});
  }
  /// A wall from a to b, `low` … `high` above the height 0; it faces to the left of the way from a to b.
  void add_wall(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double low, double high) {
    const Eigen::Vector2d along = b - a;
    add({a.x(), a.y(), low}, {0.0, 0.0, high - low}, {along.x(), along.y(), 0.0});
  }
  /// Drives straight to a place, with heights that scatter by the scene's noise.
  void drive_to(const Eigen::Vector3d& to) {
    if (path.empty()) path.push_back(to);
    const Eigen::Vector3d from = path.back();
    const int steps = static_cast<int>(std::ceil((to - from).norm() / 0.1));
    for (int i = 1; i <= steps; ++i) {
      const Eigen::Vector3d p = from + (to - from) * i / steps;
      path.push_back(p + noise() * Eigen::Vector3d::UnitZ());
    }
  }

  std::vector<MapPoint> points;
  std::vector<Eigen::Vector3d> path;

 private:
  double noise() { return noise_m_ > 0.0 ? noise_m_ * normal_(generator_) : 0.0; }

  std::mt19937 generator_{7};
  double noise_m_;
  std::normal_distribution<double> normal_;
};

}  // namespace isobar::test
