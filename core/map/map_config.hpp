// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the local map.
#pragma once

#include <cstdint>

#include "core/name_table.hpp"

namespace isobar {

/// Data association between a scan point and a plane of the map.
enum class Matcher : std::uint8_t {
  kPlaneHash,  ///< plane of the cell that contains the point; nearest plane if that cell has none
  kNearest,    ///< plane whose point is nearest, by k-d trees (the paper's method)
};

inline constexpr NameTable<Matcher, 2> kMatcherNames{{{
    {Matcher::kPlaneHash, "plane-hash"},
    {Matcher::kNearest, "nearest"},
}}};

/// Size and density of the local map, and when it takes a scan.
struct MapConfig {
  Matcher matcher = Matcher::kPlaneHash;
  /// Edge of a plane cell [m]. Smaller cells follow finer indoor detail, larger ones save memory outdoors.
  /// 0.275 was the most accurate of 0.25 … 0.3 over the short scenarios.
  double cell_m = 0.275;
  /// Tiles whose centre is farther than this from the robot leave memory [m]. At least the range of the
  /// registration, beyond which nothing is matched.
  double radius_m = 70.0;
  /// The map takes a scan that was recorded this far from the last one it took [m].
  double update_distance_m = 0.15;
  /// The map takes a scan that is rotated by this much from the last one it took [deg].
  double update_angle_deg = 4.0;
  /// The map takes a scan this long after the last one it took [s]: the scene changes while the robot stands.
  double update_interval_s = 1.0;
  /// The map takes a scan of which less than this share was matched (0 … 1): a door opened, or the place is
  /// new.
  double update_overlap = 0.75;
  /// Number of observations after which a cell's plane is frozen. Enough to average the lidar's noise; few
  /// enough that the plane stays as it was at the first visit, unaffected by the drift at later ones.
  int freeze_observations = 80;
  /// Maximum thickness (standard deviation along the normal) of a plane [m]. The noise of a VLP-16 is
  /// 0.01 … 0.03 m.
  double max_thickness_m = 0.05;
  /// Maximum standard deviation of a normal's direction [deg]. Worse planes are not matched.
  double max_normal_deviation_deg = 4.0;
  /// A cell that rays have passed through more often than this is removed. 0 keeps every cell.
  int see_through_limit = 3;
  /// A ray counts as passing through if it ends this far behind the surface [m]: above the noise of range and
  /// height.
  double see_through_margin_m = 0.35;
  /// Cells farther than this from the lidar are not tested for being seen through [m].
  double see_through_range_m = 25.0;
};

}  // namespace isobar
