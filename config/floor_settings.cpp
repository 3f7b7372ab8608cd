// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {

void add_floor_settings(FloorSettings& floors, std::vector<Setting>& settings) {
  SectionBuilder s("floors", UsedBy::kRobot, settings);
  s.flag("enabled", floors.enabled,
         "Tells the floors of the building while the robot drives, publishes the one that it is on, and the "
         "occupancy "
         "grid of that floor for navigation.");
  s.number("interval_s", &floors.interval_s, "s", 0.5, 600.0,
           "Shortest time between two grids of one floor. Another floor's comes at once.");
  s.number(
      "cpu_share", &floors.cpu_share, "", 0.01, 1.0,
      "Share of one core that floors and grids take: a large map has its grid less often. 0.2: a building "
      "of 50 m has one a second, with 0.1 s of CPU each.");
  s.number("resolution_m", &floors.grid.resolution_m, "m", 0.02, 1.0,
           "Edge of a cell of the grid. 0.05: as Nav2 expects it.");
  s.number("lowest_obstacle_m", &floors.grid.lowest_obstacle_m, "m", 0.03, 1.0,
           "Height above the ground from which a surface is an obstacle. 0.15: door sills and kerbs that the "
           "robot crosses "
           "are none.");
  s.number("robot_height_m", &floors.grid.robot_height_m, "m", 0.2, 10.0,
           "Height of the robot: what is higher above the ground is no obstacle.");
}

}  // namespace isobar
