// SPDX-License-Identifier: BSD-3-Clause
// Trajectory of a run as its loops correct it, beside the one that was estimated live.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>

namespace isobar::files {

/// Corrected pose of a live pose T_map_base at a stamp [ns].
using PoseCorrection = std::function<Eigen::Isometry3d(std::int64_t, const Eigen::Isometry3d&)>;

/// Writes kCorrectedTrajectoryFile of a map frame: every pose of its kTrajectoryFile, corrected. Replaces the file as a
/// whole. A last line that is cut is left out.
/// @return number of poses
/// @throws DataError for a trajectory that cannot be read; ServiceError when the disk refuses
std::uint64_t write_corrected_trajectory(const std::filesystem::path& directory, std::uint32_t session,
                                         const PoseCorrection& correction);

}  // namespace isobar::files
