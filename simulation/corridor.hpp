// SPDX-License-Identifier: BSD-3-Clause
// Corridors of a storey with what lies along them: doors, rooms, windows, furniture, beams, lamps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// A line of corridor legs, all along an axis, joined at right angles.
struct Corridor {
  std::vector<Eigen::Vector2d> corners_m;
  double width_m = 2.2;
  double ceiling_m = 2.9;
  int bare_leg = -1;  ///< leg with a stretch without any feature, -1 for none
  double bare_start_m = 0.0;
  double bare_end_m = 0.0;

  [[nodiscard]] std::size_t legs() const { return corners_m.size() - 1; }
  [[nodiscard]] double length_m() const;
  [[nodiscard]] Rect leg_rect(std::size_t leg) const;
};

/// One storey under construction.
struct Storey {
  FloorPlan plan;
  std::vector<Rect> taken;  ///< where no room may come: corridors, wells, other rooms
  double z_m = 0.0;
};

/// A corridor of `legs` legs (odd; first and last along +x) of `length_m` in all, from the origin.
[[nodiscard]] Corridor draw_corridor(Random& random, int legs, double length_m);

/// Cuts the corridor and everything along it; adds furniture to `mesh`.
void add_corridor(const Corridor& corridor, Storey& storey, Mesh& mesh, Random& random);

}  // namespace isobar::simulation
