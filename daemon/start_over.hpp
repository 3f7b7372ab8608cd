// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>

namespace isobar {

/// What the inputs show of a start: plain values, trivially copyable.
struct InputBreaks {
  std::int64_t lidar_jump_ns = 0;    ///< last jump of the lidar's clock against the robot clock
  std::int64_t lidar_jumped_ns = 0;  ///< when it came, robot clock; 0: never
  std::int64_t imu_resumed_ns = 0;   ///< end of the last silence of the IMU, robot clock; 0: never
};

/// Finds that the input starts over: a second recording is played, or all sensors lost their power, so the robot
/// may be somewhere else. Both must agree: the lidar's clock jumps against the robot clock, and the IMU resumes
/// after a silence at the same time. A lidar that starts again alone, or gets the time of a satellite, does not
/// silence the IMU; a machine that stalls, or a lost link, leaves the lidar's clock as it is. One thread.
class StartOver {
 public:
  /// Smallest jump of the lidar's clock [ns]: beyond any delay of packets and any correction by PTP in operation.
  static constexpr std::int64_t kJumpNs = 1'000'000'000;
  /// Shortest silence of the IMU [ns]: 60 samples at 200 Hz.
  static constexpr std::int64_t kSilenceNs = 300'000'000;
  /// Largest time between the two [ns]: streams of a player do not begin at once.
  static constexpr std::int64_t kTogetherNs = 3'000'000'000;

  /// @return true once for each start
  bool check(const InputBreaks& breaks) noexcept {
    const bool jumped = breaks.lidar_jumped_ns != 0 && std::abs(breaks.lidar_jump_ns) >= kJumpNs;
    const bool together =
        breaks.imu_resumed_ns != 0 && std::abs(breaks.lidar_jumped_ns - breaks.imu_resumed_ns) <= kTogetherNs;
    if (!jumped || !together || breaks.lidar_jumped_ns == known_ns_) return false;
    known_ns_ = breaks.lidar_jumped_ns;
    ++count_;
    return true;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// When the last start was, robot clock; 0: none yet.
  [[nodiscard]] std::int64_t last_ns() const noexcept { return known_ns_; }

 private:
  std::int64_t known_ns_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace isobar
