// SPDX-License-Identifier: BSD-3-Clause
// One storey as a union of rectangles cut out of a solid block.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/mesh.hpp"

namespace isobar::simulation {

/// Axis-aligned rectangle in plan [m].
struct Rect {
  double x0 = 0.0;
  double y0 = 0.0;
  double x1 = 0.0;
  double y1 = 0.0;

  /// Smallest rectangle around two corners, grown by `margin_m` on all sides.
  static Rect around(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double margin_m = 0.0);
  [[nodiscard]] bool overlaps(const Rect& other) const;
  [[nodiscard]] bool contains(double x, double y) const { return x > x0 && x < x1 && y > y0 && y < y1; }
  [[nodiscard]] Rect grown(double margin_m) const {
    return {x0 - margin_m, y0 - margin_m, x1 + margin_m, y1 + margin_m};
  }
};

/// An empty space over a rectangle, heights relative to the storey's floor.
struct Space {
  Rect rect;
  double floor_m = 0.0;
  double ceiling_m = 3.0;
  bool has_floor = true;    ///< false: open to the storey below
  bool has_ceiling = true;  ///< false: open to the storey above
  bool outdoors = false;    ///< no surfaces at all, not even walls towards it
};

/// Spaces in the order they were cut: where two overlap, the later one holds. Walls, floors and ceilings
/// follow from the borders, so that a plan can have no gap.
class FloorPlan {
 public:
  void cut(const Space& space) { spaces_.push_back(space); }
  /// The space at a point, or nullptr inside the solid.
  [[nodiscard]] const Space* at(double x, double y) const;
  /// Adds all surfaces to `mesh`, the storey's floor at height z_m.
  void build(Mesh& mesh, double z_m) const;

 private:
  struct Grid;
  void add_levels(Mesh& mesh, const Grid& grid, double z_m) const;
  void add_walls(Mesh& mesh, const Grid& grid, double z_m, int axis) const;

  std::vector<Space> spaces_;
};

}  // namespace isobar::simulation
