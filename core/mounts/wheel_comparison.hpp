// SPDX-License-Identifier: BSD-3-Clause
// The wheels against the scans: yaw of the lidar and scale of the distance on straight drives, track width in turns.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/mounts/running_mean.hpp"

namespace isobar {

/// Motion of one scan as wheels, gyro and scans see it.
struct WheelMotion {
  Eigen::Quaterniond q_map_base;  ///< attitude by the configured mount, smoothed
  Eigen::Vector3d p_map_base_m;
  Eigen::Quaterniond q_odom_base;  ///< of the frame in which p_odom_base_m moves
  Eigen::Vector3d p_odom_base_m;   ///< by the wheels
  double gyro_turn_z_rad = 0.0;    ///< about z of base_link, since the scan before
  double wheel_turn_rad = 0.0;     ///< the same by the wheels; NaN: unknown
  bool wheels_valid = false;
};

/// Compares stretches of the way. Allocates nothing.
class WheelComparison {
 public:
  /// The next scan; scans come in order of time.
  void add(const WheelMotion& scan);
  /// Scans are missing: the next one begins a new stretch.
  void interrupt();

  /// Yaw of the true mount against the configured one [rad], as the direction of straight drives shows it.
  [[nodiscard]] const RunningMean& yaw_rad() const { return yaw_rad_; }
  /// Distance by the scans over distance by the wheels, on level ground.
  [[nodiscard]] const RunningMean& distance_scale() const { return distance_scale_; }
  /// Turn by the gyro over turn by the wheels.
  [[nodiscard]] const RunningMean& turn_scale() const { return turn_scale_; }

 private:
  void add_turn(const WheelMotion& scan);
  void end_straight(const WheelMotion& scan);

  // Smallest errors of one stretch: slip lasts a second, a scan's position has an error of millimetres.
  RunningMean yaw_rad_{0.005};
  RunningMean distance_scale_{0.02};
  RunningMean turn_scale_{0.05};

  bool started_ = false;
  WheelMotion first_{};
  double gyro_turn_rad_ = 0.0;   // of the stretch under way
  double wheel_turn_rad_ = 0.0;  // the same
};

}  // namespace isobar
