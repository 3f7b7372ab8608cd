// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {

void add_loop_settings(LoopConfig& loops, std::vector<Setting>& settings) {
  SectionBuilder s("loops", UsedBy::kRobot, settings);
  s.flag("enabled", loops.enabled,
         "Finds places that the robot sees again, corrects the map by them, and writes the trajectory as "
         "corrected "
         "by them to trajectory-corrected.tum.");
  s.number("memory_mb", &loops.memory_mb, "MB", 1.0, 100'000.0,
           "Memory for what places are known by; beyond it those used longest ago are read from the disk. "
           "160: 15 km of "
           "corridors, 2 km of streets.");
  s.number("max_disk_gb", &loops.max_disk_gb, "GB", 0.1, 1000.0,
           "Disk space of the scans from which the map is laid anew, a map frame; beyond it the oldest are "
           "removed, and "
           "the map is corrected no more.");
  s.number("move_map_m", &loops.move.least_m, "m", 0.0, 100.0,
           "Where a part of the map is off by this much after places were seen again, the whole map is laid "
           "anew, and map "
           "-> odom jumps with it. 0: never.");
}

}  // namespace isobar
