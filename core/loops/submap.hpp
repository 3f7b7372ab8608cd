// SPDX-License-Identifier: BSD-3-Clause
// Submap: a piece of the way with a map of its own, which later corrections move as a whole.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/loops/chain_link.hpp"
#include "core/loops/key_scan.hpp"
#include "core/map/local_map.hpp"
#include "core/map/map_snapshot.hpp"

namespace isobar {

/// Frame of a submap: origin at base_link of its first key scan, z up, x along the robot's heading there. Only x, y, z
/// and yaw of the frame are estimated: gravity holds the rest.
struct Submap {
  std::uint32_t number = 0;
  std::int64_t stamp_ns = 0;     ///< of the key scan with which it began
  std::optional<AirHeight> air;  ///< at that time
  ChainLink link;                ///< its place in the submap before; identity for the first
  double first_way_m = 0.0;
  double last_way_m = 0.0;
  /// Key scans whose pose this submap holds, in order of time. Their scans, and those before and after, are in its map.
  std::vector<KeyScan> keys;
  std::shared_ptr<const MapSnapshot> planes;  ///< null while it grows, and where it was forgotten
};

/// The upright frame of a pose: its position and heading, without roll and pitch.
[[nodiscard]] Eigen::Isometry3d upright(const Eigen::Isometry3d& T_map_base);

}  // namespace isobar
