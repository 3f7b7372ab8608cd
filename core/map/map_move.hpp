// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace isobar {

/// How a map frame has been corrected where the robot is, after places were seen again: the map was laid anew at corrected
/// poses, and the robot goes on in it with a pose that jumps, in `map` but not in `odom`.
struct MapMove {
  std::uint32_t number = 0;  ///< corrections since the start of the map frame
  /// All corrections together: pose in the present map = T_now_first * pose in the map as it was first laid. About z only.
  Eigen::Isometry3d T_now_first = Eigen::Isometry3d::Identity();

  /// The corrections since `before`.
  [[nodiscard]] Eigen::Isometry3d since(const MapMove& before) const {
    return T_now_first * before.T_now_first.inverse();
  }
};

}  // namespace isobar
