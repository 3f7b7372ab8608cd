// SPDX-License-Identifier: BSD-3-Clause
// The mount that was found, as the line that belongs into the configuration.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/estimates.hpp"

namespace isobar {

/// "[0.12, -0.34, 0.00]": angles [deg] with two decimals, as TOML.
std::string rpy_text(const Eigen::Vector3d& rpy_deg);

/// "lidar.rpy_deg = [0.52, -0.31, 1.00]  # +- 0.06, 0.06, 0.10; was [0.00, 0.00, 1.00]": the corrected mount, with 1 sigma.
/// Yaw is that of the configuration where it was not found.
/// @param configured_rpy_deg lidar.rpy_deg of the run
std::string mount_line(const MountState& mount, const Eigen::Vector3d& configured_rpy_deg);

/// Content of mounts.toml, ready for a folder conf.d: the line above, a comment line where nothing was found, and the scale
/// of the wheels as comments, for which Isobar has no setting: it belongs into what computes their speeds.
std::string mounts_file_text(const MountState& mount, const Eigen::Vector3d& configured_rpy_deg);

}  // namespace isobar
