// SPDX-License-Identifier: BSD-3-Clause
// A trajectory as the evaluation sees it: time-ordered poses of base_link, and where they come from.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::evaluation {

/// Pose of base_link in the trajectory's own gravity-aligned frame.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude =
      Eigen::Quaterniond::Identity();  ///< unit length; rotates base_link into the frame
};

/// What had to be repaired to make stamps strictly increase.
struct StampRepairs {
  std::size_t duplicates = 0;  ///< poses dropped because an earlier line had the same stamp
  std::size_t backwards = 0;   ///< poses that stood after a later one and were sorted
};

/// Poses with strictly increasing stamps.
struct Trajectory {
  std::vector<StampedPose> poses;
  StampRepairs repairs;

  [[nodiscard]] bool empty() const { return poses.empty(); }
  /// Time from the first to the last pose [s]; 0 if there are fewer than two.
  [[nodiscard]] double duration_s() const;
};

/// Sorts by stamp and drops all but the first of equal stamps, counting both.
Trajectory make_trajectory(std::vector<StampedPose> poses);

/// Parses the TUM trajectory format: `t x y z qx qy qz qw`, t in seconds, '#' starts a comment line. Blank
/// lines, CRLF, commas or tabs between the numbers are accepted; quaternions are normalised. The stamp is
/// read digit by digit, so that nine decimals give exact nanoseconds. `name` is what errors call the text.
/// Throws DataError "name:line: rule" on a broken line, and if the text has no pose.
Trajectory parse_tum(std::string_view text, const std::string& name);

/// Travelled distance at each pose [m]: the length of the polygon through poses that lie at least
/// `min_step_m` apart, so that noise of a robot at rest does not count as travel; poses between its corners
/// share out the side by the raw path's length. Never decreases; same length as `poses`.
std::vector<double> travelled_distance_m(const std::vector<StampedPose>& poses, double min_step_m = 0.05);

/// Rotation about z of an attitude [rad], -pi … pi (yaw of the fixed-axis x, y, z angles of REP-103).
double yaw_rad(const Eigen::Quaterniond& attitude);

/// Angle in -pi … pi that differs from `angle_rad` by whole turns.
double wrap_angle_rad(double angle_rad);

}  // namespace isobar::evaluation
