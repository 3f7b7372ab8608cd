// SPDX-License-Identifier: BSD-3-Clause
// A replay that asks a MountEstimator for the mount of the lidar.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>

#include "config/config.hpp"
#include "core/mounts/mount_estimator.hpp"

namespace isobar::tools {

/// What one recording says about the mount of its lidar.
struct MountReplay {
  Eigen::Vector3d configured_rpy_deg = Eigen::Vector3d::Zero();  ///< mount in the recording's manifest
  MountEstimate estimate;                                        ///< error of that mount
  double way_m = 0.0;                                            ///< by the registered scans
  double turn_deg = 0.0;  ///< sum of the turns about all axes, by the gyro
  std::uint64_t scans = 0;
  std::uint64_t registered = 0;
};

/// Replays a recording with 6-DOF, the method whose attitude is free of gravity. `error_rad`: error of the configured
/// mount by an earlier replay, with which this one registers; the estimate refers to the configured mount all the same.
/// @param progress called with 0 … 1
/// @throws DataError for a recording that cannot be used
MountReplay replay_for_mount(const std::filesystem::path& recording, const Config& config,
                             const Eigen::Vector3d& error_rad, const std::function<void(double)>& progress);

}  // namespace isobar::tools
