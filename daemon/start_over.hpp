// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>

namespace isobar {

/// What the inputs show of a start: plain values, trivially copyable.
struct InputBreaks {
  std::int64_t lidar_jumped_ns =
      0;                          ///< last jump of the lidar's clock (ClockContinuity), robot clock; 0: never
  std::int64_t imu_began_ns = 0;  ///< last time that the IMU's stream began anew, robot clock; 0: never
};

/// Finds that the input starts over: a recording is played from another moment on, or another one, so the robot
/// may be somewhere else. Lidar and IMU must both begin anew, together. A lidar or an IMU that starts again alone
/// does not move the robot; sensors that lost their power start one after the other, the lidar's motor much later;
/// and whatever stands still, delivers late or loses packets leaves the sensors' clocks as they are. One thread.
class StartOver {
 public:
  /// Shortest silence of an IMU over DDS after which its stream has begun anew [ns]: 60 samples at 200 Hz.
  static constexpr std::int64_t kSilenceNs = 300'000'000;
  /// Largest time between the two [ns]: streams of a player do not begin at once.
  static constexpr std::int64_t kTogetherNs = 3'000'000'000;

  /// @return true once for each start
  bool check(const InputBreaks& breaks) noexcept {
    const bool is_new = breaks.lidar_jumped_ns != known_.lidar_jumped_ns && breaks.lidar_jumped_ns != 0 &&
                        breaks.imu_began_ns != known_.imu_began_ns && breaks.imu_began_ns != 0;
    if (!is_new || std::abs(breaks.lidar_jumped_ns - breaks.imu_began_ns) > kTogetherNs) return false;
    known_ = breaks;
    ++count_;
    return true;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// When the last start was, robot clock; 0: none yet.
  [[nodiscard]] std::int64_t last_ns() const noexcept { return known_.lidar_jumped_ns; }

 private:
  InputBreaks known_;  ///< those of the last start
  std::uint64_t count_ = 0;
};

}  // namespace isobar
