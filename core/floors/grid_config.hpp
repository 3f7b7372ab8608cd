// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar {

/// Shape of the robot and limits of an occupancy grid.
struct GridConfig {
  double resolution_m = 0.05;       ///< 0.02 … 1 m
  double lowest_obstacle_m = 0.15;  ///< above the ground below it: lower ones count as ground
  double driven_obstacle_m =
      0.4;  ///< the same where the robot drove: steps, and what lay in its way and is gone
  double robot_height_m = 1.5;  ///< what is higher above the ground is no obstacle: lintels, ceilings
  double path_radius_m = 0.25;  ///< around the path of base_link, what the robot itself has passed
  double surface_m =
      0.0917;           ///< edge of the patch of a surface that a point stands for: a third of a map's cell
  double ray_m = 15.0;  ///< free space is told up to this far from the path
  double most_unseen_ground_m = 2.5;  ///< length of a ray over places where the map holds no ground
  int confirmed_observations = 30;    ///< of what has no plane: people who walk by leave fewer
  int wall_observations = 10;         ///< of at least one plane of a connected obstacle
  double cells_at_most = 4e8;         ///< larger grids are refused: 1 km x 1 km at 5 cm
};

}  // namespace isobar
