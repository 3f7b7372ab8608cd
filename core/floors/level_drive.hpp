// SPDX-License-Identifier: BSD-3-Clause
// The parts of a path that were driven level.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace isobar {

/// A place of the path; places are kStepM of horizontal way apart.
struct DrivenPlace {
  static constexpr double kStepM = 0.25;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< as in the path
  bool is_level = false;                            ///< slope over some metres around it
};

/// Places of a path. An elevator is a jump in height between two places, and none of them. The first and the last place
/// of the path are always among them; points that are not finite are left out.
/// @param path positions in order of time [m]
/// @param most_slope of a level drive
[[nodiscard]] std::vector<DrivenPlace> driven_places(std::span<const Eigen::Vector3d> path,
                                                     double most_slope);

}  // namespace isobar
