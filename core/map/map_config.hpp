// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the local map.
#pragma once

#include <cstdint>

#include "core/name_table.hpp"

namespace isobar {

/// How a point of the scan finds its plane of the map.
enum class Matcher : std::uint8_t {
  kPlaneHash,  ///< the plane of the cell that it is in; where there is none, the nearest one
  kNearest,    ///< the plane whose point is nearest (the paper's), by k-d trees
};

inline constexpr NameTable<Matcher, 2> kMatcherNames{{{
    {Matcher::kPlaneHash, "plane-hash"},
    {Matcher::kNearest, "nearest"},
}}};

/// Size and density of the local map, and when it changes.
struct MapConfig {
  /// How points are matched to planes.
  Matcher matcher = Matcher::kPlaneHash;
  /// Edge of a plane cell [m]. Smaller follows finer indoor detail, larger needs fewer cells
  /// outdoors. 0.275 was the most accurate of 0.25 … 0.3 over the short scenarios.
  double cell_m = 0.275;
  /// Tiles whose centre is farther than this from the robot leave memory [m]. Beyond the reach of
  /// the registration nothing is matched.
  double radius_m = 70.0;
  /// The map takes a scan when the robot moved this far since the last one it took [m].
  double update_distance_m = 0.15;
  /// … or turned this far [deg].
  double update_angle_deg = 4.0;
  /// … or this long ago [s]: things move while the robot stands.
  double update_interval_s = 1.0;
  /// … or when less than this share of the scan found the map: a door opened, the place is new.
  double update_overlap = 0.75;
  /// Observations after which a cell's plane no longer changes. Enough to average the lidar's
  /// noise; few enough that the oldest pose counts, which keeps drift out of places seen twice.
  int freeze_observations = 80;
  /// Largest thickness (standard deviation along the normal) of a cell that counts as a plane [m]. The noise
  /// of a VLP-16 is 0.01 … 0.03 m.
  double max_thickness_m = 0.05;
  /// Largest standard deviation of a normal's direction [deg]. Worse ones are not matched.
  double max_normal_deviation_deg = 4.0;
  /// Points seen through this often leave the map. 0 keeps everything.
  int see_through_limit = 3;
  /// A ray must pass a point's surface by this much to count as seen through [m]: above the noise of
  /// range and height.
  double see_through_margin_m = 0.35;
  /// Points farther than this from the robot are not tested for being seen through [m].
  double see_through_range_m = 25.0;
};

}  // namespace isobar
