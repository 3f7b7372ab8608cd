// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/import/import_plan.hpp"

namespace isobar::tools {

/// The mount of a pose of the sensor in base_link.
[[nodiscard]] Mount mount_of(const Eigen::Isometry3d& T_base_sensor);

/// Puts the mounts into the manifest: those that a person gave, else those of the frames. Without any, base_link lies in
/// the lidar, which costs nothing; where the IMU sits on the lidar must be known.
/// @throws UsageError naming --mount imu
void place_sensors(const TopicSurvey& survey, const ImportRequest& request, ImportPlan& plan,
                   std::vector<std::string>& notes);

}  // namespace isobar::tools
