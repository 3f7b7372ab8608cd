// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace isobar {

/// Place in a known map where the robot was last: the start of a run that continues another one.
struct KnownPlace {
  /// Anywhere in the map: x, y and yaw say nothing, and nothing is searched around them. The rest holds.
  bool anywhere = false;
  std::uint32_t session = 1;  ///< number of the map frame
  std::int64_t stamp_ns = 0;  ///< time of the pose, robot clock
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  double overlap = 0.0;         ///< of the last scans that matched the map; 0: unknown
  double residual_rms_m = 0.0;  ///< the same
  bool has_height = false;      ///< the prior will continue the height of this map: the search waits for it
  double height_m = 0.0;        ///< of the prior at that time, if it has one: not z where the scans give z
  Eigen::Vector3d v_map_m_s = Eigen::Vector3d::Zero();  ///< velocity at that time
  double yaw_rate_rad_s = 0.0;                          ///< the same, about the map's z
};

}  // namespace isobar
