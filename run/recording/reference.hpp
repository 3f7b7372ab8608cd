// SPDX-License-Identifier: BSD-3-Clause
// Reference trajectory of a recording, in the TUM format.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::recording {

struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
};

/// Reads a trajectory (rows: text::next_tum_row()).
/// @throws DataError "file:line: rule" when a row breaks the format
std::vector<StampedPose> read_tum(const std::filesystem::path& file);

/// One TUM row with its newline: nine decimals of time, the other numbers in the shortest text of the same
/// bits.
std::string format_tum_row(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base);

/// Writes a whole trajectory.
/// @throws DataError when the file cannot be written
void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses);

}  // namespace isobar::recording
