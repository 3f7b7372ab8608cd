// SPDX-License-Identifier: BSD-3-Clause
// Direction and unit of the wheels' way, and the yaw of the lidar.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/contradictions/finding.hpp"
#include "core/contradictions/motion_comparison.hpp"

namespace isobar {

/// What tells a reversed way of the wheels from a lidar that looks backwards.
struct WayWitnesses {
  std::optional<double> acceleration;  ///< compare_accelerations(); nothing: not known
  bool wheels_turn_reversed = false;   ///< their turn is reversed, too
};

/// Adds what is wrong with the wheels' way or the lidar's yaw: after two metres in three seconds or more, with a correlation
/// of 0.9 or more. Angle: 20 deg and more, five times what a mount is found to be off by in the field; less is the
/// adaptive method's. Unit: beyond 0.4 … 2.5 times, where neither slip nor worn wheels reach.
void add_way_findings(const WayRatio& way, const WayWitnesses& witnesses,
                      const Eigen::Vector3d& lidar_rpy_deg, Findings& findings);

}  // namespace isobar
