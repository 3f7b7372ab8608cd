// SPDX-License-Identifier: BSD-3-Clause
// Files beside the sensor data: trajectories in the TUM format and the named time spans of the evaluation.
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

struct Segment {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::string label;  ///< flat, stairs, elevator, ramp, outdoor or any other word
};

/// Reads "t x y z qx qy qz qw", t in seconds (converted to ns without loss), '#' comments. Throws DataError
/// "file:line: rule" for a row that is not finite, has no unit quaternion or has another number of columns.
std::vector<StampedPose> read_tum(const std::filesystem::path& file);

/// One TUM row with nine decimals of time, without loss in the other numbers, and a newline.
std::string format_tum_row(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base);

/// Writes a whole trajectory. Throws DataError.
void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses);

/// Reads segments.csv (t_start_ns, t_end_ns, label). Throws DataError "file:line: rule".
std::vector<Segment> read_segments(const std::filesystem::path& file);

}  // namespace isobar::recording
