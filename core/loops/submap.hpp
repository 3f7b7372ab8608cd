// SPDX-License-Identifier: BSD-3-Clause
// Submap: a piece of the way with a map of its own, which later corrections move as a whole.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/loops/key_scan.hpp"
#include "core/map/local_map.hpp"
#include "core/map/map_snapshot.hpp"

namespace isobar {

/// Frame of a submap: origin at base_link of its first key scan, z up, x along the robot's heading there. Only x, y, z
/// and yaw of the frame are estimated: gravity holds the rest.
struct Submap {
  std::uint32_t number = 0;
  double first_way_m = 0.0;
  double last_way_m = 0.0;
  /// Key scans whose pose this submap holds, in order of time. Their scans, and those before and after, are in its map.
  std::vector<KeyScan> keys;
  std::shared_ptr<const MapSnapshot> planes;  ///< never null once the submap is complete
};

/// The upright frame of a pose: its position and heading, without roll and pitch.
[[nodiscard]] Eigen::Isometry3d upright(const Eigen::Isometry3d& T_map_base);

}  // namespace isobar
