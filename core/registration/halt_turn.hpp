// SPDX-License-Identifier: BSD-3-Clause
// Contradiction of scans and gyro while the robot stands: what the scans turn the map by, the gyro has not felt. The doors
// of a cabin, people, a crowd of carts that roll by turn the pose of a robot that does not move.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/geometry.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

/// Turn of a halt that only the scans show. Allocates nothing.
class HaltTurn {
 public:
  /// The robot stands. `yaw_map_odom_rad`: yaw of T_map_odom, which changes where scans and gyro disagree.
  void stand(std::int64_t stamp_ns, double yaw_map_odom_rad) {
    if (!standing_) {
      *this = {};
      standing_ = true;
      since_ns_ = stamp_ns;
      yaw_rad_ = yaw_map_odom_rad;
    }
    const double turned_rad = std::abs(std::remainder(yaw_map_odom_rad - yaw_rad_, 2.0 * kPi));
    excess_rad_ = std::max(0.0, turned_rad - kScanRad - kGyroRadS * seconds_between(since_ns_, stamp_ns));
  }
  /// The robot moves on.
  void leave() { *this = {}; }

  [[nodiscard]] bool standing() const { return standing_; }
  /// Of yaw: the whole contradiction, 1 sigma, since none of the two is known to be right [rad^2].
  [[nodiscard]] double variance_rad2() const { return squared(excess_rad_); }

 private:
  // What scans against one map, and a gyro at rest may disagree by.
  static constexpr double kScanRad = 0.03 * kRadPerDeg;
  static constexpr double kGyroRadS = 0.003 * kRadPerDeg;

  std::int64_t since_ns_ = 0;
  double yaw_rad_ = 0.0;
  double excess_rad_ = 0.0;
  bool standing_ = false;
};

}  // namespace isobar
