// SPDX-License-Identifier: BSD-3-Clause
// Moving ground (elevator) as wheels and air show it, without an IMU.
#pragma once

#include <cmath>

namespace isobar {

/// A ride: the wheels stand, and the height of the air leaves that of the floor at the speed of a lift. It is seen after
/// the first metre, because a door's pulse of 8 Pa is 0.7 m; the way until then is in the height all the same.
class AirRide {
 public:
  /// One step of `dt_s`. `height_m`: of the air, not filtered, which would shoot over a pulse; `vz_m_s`: filtered.
  void add(bool wheels_stand, double height_m, double vz_m_s, double dt_s) {
    const bool slow = std::abs(vz_m_s) < (rides_ ? kStoppedMS : kLiftMS);
    slow_s_ = slow ? slow_s_ + dt_s : 0.0;
    if (!wheels_stand || (rides_ && slow_s_ > kStoppedS)) {
      rides_ = false;
      floor_m_ = height_m;
      return;
    }
    if (rides_) return;
    if (slow_s_ > kStoppedS) floor_m_ += (height_m - floor_m_) * std::fmin(1.0, dt_s / kFloorMemoryS);
    rides_ = !slow && std::abs(height_m - floor_m_) > kLeastRiseM;
  }

  [[nodiscard]] bool rides() const { return rides_; }

 private:
  static constexpr double kLeastRiseM = 1.0;
  // Vertical speed of a lift, and of one that has stopped, of the air's height [m/s].
  static constexpr double kLiftMS = 0.25;
  static constexpr double kStoppedMS = 0.12;
  static constexpr double kStoppedS = 1.0;
  static constexpr double kFloorMemoryS = 5.0;

  double floor_m_ = 0.0;  // height of the air before the ride
  double slow_s_ = 0.0;   // how long the height has hardly changed
  bool rides_ = false;
};

}  // namespace isobar
