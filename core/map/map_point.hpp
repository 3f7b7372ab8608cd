// SPDX-License-Identifier: BSD-3-Clause
// What the map hands out: points to keep and matches to register against.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// One point of the map for files and viewers.
struct MapPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< position in the map frame [m]
  Eigen::Vector3f normal_map =
      Eigen::Vector3f::Zero();  ///< unit normal towards the observer, zero if unknown
  std::uint8_t intensity = 0;   ///< calibrated reflectivity
};

/// The plane of the map nearest to a query.
struct MapMatch {
  Eigen::Vector3d q_map = Eigen::Vector3d::Zero();       ///< a point on the plane [m]
  Eigen::Vector3f normal_map = Eigen::Vector3f::Zero();  ///< unit normal towards the observer
  float distance_m = 0.0F;                               ///< from the query to q_map
};

}  // namespace isobar
