// SPDX-License-Identifier: BSD-3-Clause
// Scans of a room by ray casting, closed form.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/samples.hpp"

namespace isobar::test {

/// Walls around the origin [m].
struct Room {
  double west = -3.0, east = 5.0, south = -2.5, north = 3.5;
};

/// A scan of 16 rings and 900 azimuths that ends at `end_ns`, 0.1 s long, from the lidar's pose in the room; the whole
/// scan at that pose. `R_base_lidar`: the points are in the lidar's frame.
void scan_room(const Room& room, const Eigen::Isometry2d& T_room_base, const Eigen::Matrix3d& R_base_lidar,
               std::int64_t end_ns, Scan& scan);

}  // namespace isobar::test
