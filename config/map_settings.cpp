// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"
#include "core/map/cell_moments.hpp"

namespace isobar {
namespace {

void add_size(MapConfig& map, SectionBuilder& s) {
  s.choice(
      "matcher", &map.matcher, matcher_choices(),
      "Association of a scan's point with a plane of the map. plane-hash: the plane of the point's cell, "
      "else the nearest one. nearest: always the nearest one, by k-d trees, as in the paper. As accurate "
      "as each other; plane-hash takes about six tenths of the time.");
  s.number("cell_m", &map.cell_m, "m", 0.1, 1.0,
           "Edge of a plane cell. Smaller cells follow finer indoor detail, larger ones are fewer outdoors; "
           "0.275 was the most accurate of 0.25 to 0.3 over the short scenarios.");
  s.applies(Apply::kLive);
  s.number(
      "radius_m", &map.radius_m, "m", 20.0, 200.0,
      "Distance from the robot beyond which tiles leave memory. 70: beyond the reach of the registration "
      "nothing is matched.");
}

void add_update(MapConfig& map, SectionBuilder& s) {
  s.number("update_distance_m", &map.update_distance_m, "m", 0.0, 2.0,
           "Distance after which the map takes the next scan; it also takes one after update_angle_deg, "
           "after update_interval_s, or below update_overlap. 0.15: about half a cell.");
  s.number("update_angle_deg", &map.update_angle_deg, "deg", 0.0, 45.0,
           "Turn after which the map takes the next scan. 4: at 5 m, about one cell.");
  s.number("update_interval_s", &map.update_interval_s, "s", 0.1, 60.0,
           "Time after which the map takes the next scan. 1: things move while the robot stands.");
  s.number(
      "update_overlap", &map.update_overlap, "", 0.0, 1.0,
      "Share of a scan's points matched to the map below which the map takes the scan: a door opened, "
      "the place is new. Of scans less than 0.2 s apart each gives a part of its points, in turns, if at "
      "least half of it was matched.");
}

void add_planes(MapConfig& map, SectionBuilder& s) {
  s.number("freeze_observations", &map.freeze_observations, "", 8, CellMoments::kMostPoints,
           "Observations after which a cell's plane no longer changes. 80: enough to average the lidar's "
           "noise; the first poses count, which keeps drift out of places seen twice.");
  s.number("max_thickness_m", &map.max_thickness_m, "m", 0.01, 0.2,
           "Largest thickness of a cell that counts as a plane: standard deviation along its normal. 0.05: "
           "the noise of a VLP-16 is 0.01 to 0.03.");
  s.number("max_normal_deviation_deg", &map.max_normal_deviation_deg, "deg", 0.5, 15.0,
           "Largest standard deviation of a normal's direction; worse planes are not matched. 4: more would "
           "imitate information along a corridor.");
}

void add_removal(MapConfig& map, SectionBuilder& s) {
  s.number("see_through_limit", &map.see_through_limit, "", 0, 50,
           "Rays through a point after which it leaves the map: people who walked on. 3: a single wrong "
           "return removes nothing. 0 keeps every point.");
  s.number("see_through_margin_m", &map.see_through_margin_m, "m", 0.1, 2.0,
           "Distance by which a ray must pass a surface to count as through it. 0.35: above the noise of "
           "range and height.");
  s.number("see_through_range_m", &map.see_through_range_m, "m", 2.0, 100.0,
           "Largest distance from the robot at which points are tested for rays through them. 25: the "
           "rings of a VLP-16 are 0.9 m apart there.");
}

void add_files(MapFileSettings& files, SectionBuilder& s) {
  s.applies(Apply::kRestart);
  s.text("directory", files.directory, TextRule::kAny,
         "Folder for the tiles of the map; a map of an earlier run is continued. Must be new, empty or "
         "isobard's "
         "own. Empty: the folder map in output.directory; if that is empty too, tiles that leave memory are "
         "lost.");
  s.number("max_disk_gb", &files.max_disk_gb, "GB", 0.001, 1'000.0,
           "Largest size of the tile files; beyond it the tiles that left memory longest ago are deleted. 4: "
           "ten million points take about half of 1 GB.");
  s.text("stored", files.stored, TextRule::kAny,
         "Stored map in which the run begins, anywhere in it: the folder of a run or of a map. It is never "
         "changed. Empty: "
         "that of the run which output.directory or map.directory holds, at its last place.");
  s.choice(
      "use", &files.use, kMapUseNames.names(),
      "extend: what the run sees is added to its map; of a map in stored a copy is made. localise: no map is "
      "written, the robot is found in the stored one or stays lost. new: a new map frame begins and the "
      "map that is there is kept.");
}

}  // namespace

void add_map_settings(MapConfig& map, MapFileSettings& files, std::vector<Setting>& settings) {
  SectionBuilder s("map", UsedBy::kRobot, settings);
  add_size(map, s);
  add_update(map, s);
  add_planes(map, s);
  add_removal(map, s);
  add_files(files, s);
}

}  // namespace isobar
