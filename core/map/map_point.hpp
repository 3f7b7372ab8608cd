// SPDX-License-Identifier: BSD-3-Clause
// A point of the map for files and viewers.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// Position, normal and reflectivity of one point of the map.
struct MapPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< position in the map frame [m]
  Eigen::Vector3f normal_map =
      Eigen::Vector3f::Zero();    ///< unit normal towards the observer, zero if unknown
  std::uint8_t intensity = 0;     ///< calibrated reflectivity
  std::uint8_t observations = 0;  ///< of its cell by rays, up to 127; 0: unknown
  std::uint8_t filled = 0;        ///< thirds of its cell that hold rays' ends, 1 … 27; 0: unknown
};
}  // namespace isobar
