// SPDX-License-Identifier: BSD-3-Clause
// Configuration of submaps and loops.
#pragma once

#include <cstddef>

namespace isobar {

/// When the map is laid anew at the poses that the loops have corrected.
struct MapMoveConfig {
  double least_m = 0.1;  ///< a part of the map is off by this much: walls are doubled from there on; 0: never
  double least_deg = 0.3;         ///< or turned by this
  std::size_t keys_per_step = 8;  ///< key scans laid a scan: 80 a second, a share of one core
};

/// Whether places that are seen again correct the trajectory, and what that may cost.
struct LoopConfig {
  bool enabled = true;
  /// Memory for the planes of submaps [MB]; beyond it the oldest ones are forgotten, and not found again. A submap of 10 m
  /// takes 0.1 MB in corridors and 0.7 MB in streets.
  double memory_mb = 160.0;
  /// Disk space for the key scans of a map frame [GB]; beyond it the oldest are removed, and the map is moved no more. 0.1 MB
  /// a metre in streets, half of that in corridors.
  double max_disk_gb = 4.0;
  MapMoveConfig move;
};

/// Size of submaps.
struct SubmapConfig {
  /// Way from the beginning of a submap to that of the next one [m].
  double spacing_m = 10.0;
  /// Points farther than this from the robot do not enter a submap [m].
  double radius_m = 40.0;
  /// Points of a key scan that are matched.
  std::size_t sample_points = 1200;
  /// Way between two key scans whose sample is kept to measure loops [m].
  double loop_spacing_m = 2.0;
};

/// Where loops are looked for.
struct LoopSearchConfig {
  double min_way_m = 30.0;      ///< way since the earlier visit
  double max_distance_m = 6.0;  ///< between key scans of both visits
  /// Largest difference of heights [m], and the error of it, times height_sigmas, beyond which no loop is looked for: two
  /// floors could be within it.
  double max_height_m = 1.0;
  double height_sigmas = 3.0;
  std::size_t candidates = 2;  ///< submaps that a key scan is matched to
};

}  // namespace isobar
