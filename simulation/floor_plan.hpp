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

/// Empty space above a rectangle; heights are relative to the storey's floor.
struct Space {
  Rect rect;
  double floor_m = 0.0;
  double ceiling_m = 3.0;
  bool has_floor = true;    ///< false: open to the storey below
  bool has_ceiling = true;  ///< false: open to the storey above
  bool outdoors =
      false;  ///< open air: no surfaces, no walls of neighbours towards it; rays into it have no return
};

/// Plan of a storey: spaces cut out of a solid, where a later one replaces earlier ones that it overlaps.
/// Walls, floors and ceilings are derived from the borders of the spaces, so that there are no gaps.
class FloorPlan {
 public:
  void cut(const Space& space) { spaces_.push_back(space); }
  /// Space at a point [m]; null inside the solid.
  [[nodiscard]] const Space* at(double x, double y) const;
  /// Adds all surfaces to `mesh`; `z_m`: height of the storey's floor.
  void build(Mesh& mesh, double z_m) const;

 private:
  struct Grid;
  void add_levels(Mesh& mesh, const Grid& grid, double z_m) const;
  void add_walls(Mesh& mesh, const Grid& grid, double z_m, int axis) const;

  std::vector<Space> spaces_;
};

}  // namespace isobar::simulation
