// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {

void add_black_box_settings(BlackBoxSettings& black_box, std::vector<Setting>& settings) {
  SectionBuilder s("black_box", UsedBy::kRobot, settings);
  s.number("span_s", &black_box.span_s, "s", 0.0, 600.0,
           "Time span of all inputs, lidar packets included, that isobard keeps in memory. 0: off. 60: what "
           "led to a fault, 57 MB with a VLP-16.");
  s.number("max_mb", &black_box.max_mb, "MB", 8.0, 4'096.0,
           "Most memory for these inputs; the oldest go first. At most half of the free space of the memory "
           "file system is used. 160: a minute of an HDL-32E.");
  s.text("directory", black_box.directory, TextRule::kAny,
         "Folder for saved recordings. Empty: blackbox/ in output.directory; without that, blackbox/ in the "
         "service's state folder.");
  s.number("keep", &black_box.keep, "", 1, 1'000, "Saved recordings that are kept; the oldest are deleted.");
  s.number("min_free_mb", &black_box.min_free_mb, "MB", 0.0, 1e6,
           "Free space that a save leaves on the disk; with less, nothing is saved and the log says so.");
  s.text(
      "save_on", black_box.save_on, TextRule::kAny,
      "Health entries whose change to an error saves the black box, at most once in five minutes: \"any\", "
      "\"none\", or names separated by blanks, such as \"lidar barometer\".");
}

}  // namespace isobar
