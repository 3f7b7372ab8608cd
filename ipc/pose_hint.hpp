// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace isobar::ipc {

/// Who sent a hint.
enum class PoseHintSource : std::uint8_t {
  kCommand = 0,  ///< `isobar initial-pose`
  kDds = 1,      ///< topic dds.topics.initial_pose
};

/// Where somebody says that the robot is. The registration searches there, and believes it only where the scans match.
struct PoseHint {
  PoseHintSource source = PoseHintSource::kCommand;
  bool has_z = false;         ///< z_m is stated; else the robot is at the height where it believes to be
  std::uint32_t session = 0;  ///< number of the map frame of the pose; 0: the one in force
  double x_m = 0.0;           ///< base_link in the map frame
  double y_m = 0.0;
  double z_m = 0.0;
  double yaw_rad = 0.0;
  /// Of x, y, z [m^2], roll, pitch, yaw [rad^2], row-major, map frame. A variance of zero is not stated.
  std::array<double, 36> covariance{};
};

/// The rule that a hint breaks, nullptr: none. Coordinates within 1000 km, all values finite, covariance symmetric and
/// positive semi-definite. Allocates nothing.
[[nodiscard]] const char* implausibility(const PoseHint& hint) noexcept;

}  // namespace isobar::ipc
