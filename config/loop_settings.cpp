// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {

void add_loop_settings(LoopConfig& loops, std::vector<Setting>& settings) {
  SectionBuilder s("loops", UsedBy::kRobot, settings);
  s.flag("enabled", loops.enabled,
         "Finds places that the robot sees again, and writes the trajectory as corrected by them to "
         "trajectory-corrected.tum. The poses of the run stay as they are.");
  s.number("memory_mb", &loops.memory_mb, "MB", 1.0, 100'000.0,
           "Memory for what places are known by; beyond it the oldest ones are forgotten. 160: 15 km of "
           "corridors, 2 km of streets.");
}

}  // namespace isobar
