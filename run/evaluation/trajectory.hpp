// SPDX-License-Identifier: BSD-3-Clause
// Trajectory: poses of base_link in order of time, and the TUM file format.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::evaluation {

/// Pose of base_link in the gravity-aligned frame of the trajectory.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  /// Unit length; rotates base_link into the frame.
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

/// Repairs that made the file complete and the stamps strictly ascending.
struct StampRepairs {
  std::size_t duplicates = 0;  ///< dropped: an earlier line has the same stamp
  std::size_t backwards = 0;   ///< moved: a previous line has a later stamp
  std::size_t cut_line = 0;    ///< number of the last line, left out because it is cut; 0: none
};

/// Poses with strictly ascending stamps.
struct Trajectory {
  std::vector<StampedPose> poses;
  StampRepairs repairs;

  [[nodiscard]] bool empty() const { return poses.empty(); }
  /// Time from the first to the last pose [s]; 0 for fewer than two poses.
  [[nodiscard]] double duration_s() const;
};

/// Sorts by stamp, keeps the first of equal stamps, and counts the repairs.
Trajectory make_trajectory(std::vector<StampedPose> poses);

/// Parses the TUM trajectory format: `t x y z qx qy qz qw`, t in seconds, '#' starts a comment line. Blank
/// lines, CRLF, commas or tabs between the numbers are accepted; quaternions are normalised. Stamps are read
/// digit by digit: nine decimals give exact nanoseconds. A last line that is cut (no line end, and no pose) is
/// left out: a run that ended in a power cut leaves one. `name`: name of the text in errors.
/// @throws DataError "name:line: rule" when a line breaks a rule, or when there is no pose
Trajectory parse_tum(std::string_view text, const std::string& name);

/// Travelled distance at each pose [m]: length of the polygon through poses at least `min_step_m` apart, so
/// that noise at rest does not count as travel. Poses between its corners divide a side in proportion to the
/// raw path. Non-decreasing; same length as `poses`.
std::vector<double> travelled_distance_m(const std::vector<StampedPose>& poses, double min_step_m = 0.05);

/// Yaw of an attitude [rad], -pi … pi (fixed-axis x, y, z angles of REP-103).
double yaw_rad(const Eigen::Quaterniond& attitude);

/// Angle modulo 2 pi, within -pi … pi.
double wrap_angle_rad(double angle_rad);

}  // namespace isobar::evaluation
