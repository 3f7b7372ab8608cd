// SPDX-License-Identifier: BSD-3-Clause
// Corridors of a storey, with doors, rooms, windows, furniture, beams and lamps along them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// A chain of straight, axis-parallel legs joined at right angles.
struct Corridor {
  std::vector<Eigen::Vector2d> corners_m;
  double width_m = 2.2;
  double ceiling_m = 2.9;
  int bare_leg = -1;  ///< leg with a featureless stretch (bare_start_m … bare_end_m along it); -1: none
  double bare_start_m = 0.0;
  double bare_end_m = 0.0;

  [[nodiscard]] std::size_t legs() const { return corners_m.size() - 1; }
  [[nodiscard]] double length_m() const;
  [[nodiscard]] Rect leg_rect(std::size_t leg) const;
};

/// One storey under construction.
struct Storey {
  FloorPlan plan;
  std::vector<Rect> taken;  ///< areas that no room may overlap: corridors, stairwells, other rooms
  double z_m = 0.0;
};

/// Random corridor from the origin with `legs` legs (odd; first and last along +x) and a total length of
/// `length_m`.
[[nodiscard]] Corridor draw_corridor(Random& random, int legs, double length_m);

/// Cuts the corridor and its rooms out of the storey's plan, and adds furniture to `mesh`.
void add_corridor(const Corridor& corridor, Storey& storey, Mesh& mesh, Random& random);

/// Cuts a closed door in a niche of the wall of leg `leg`, `along_m` from its start, into the storey's plan
/// and adds its frame to `mesh`. `side`: +1: left of the leg, -1: right. Does nothing where another area is in
/// the way.
void add_closed_door(const Corridor& corridor, std::size_t leg, double along_m, double side, Storey& storey,
                     Mesh& mesh, Random& random);

}  // namespace isobar::simulation
