// SPDX-License-Identifier: BSD-3-Clause
// How well one scan holds each direction of the pose, and who holds it where the scan does not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Source that knows most of a direction.
enum class Holder : std::uint8_t {
  kScan,
  kGravityDirection,  ///< roll, pitch
  kGyro,              ///< turns since the last scan
  kWheels,            ///< way since the last scan
  kAltimeter,         ///< z
  kMotion,            ///< none of these: the motion is assumed to go on
};

/// A direction in which the pose can move.
struct Direction {
  /// Unit vector of (x, y, z, roll, pitch, yaw), axes of the map about the robot; angles times the mean distance of the
  /// points, so that all are metres.
  std::array<float, 6> axis{};
  /// Probability that the scan holds it: that more than half of its information is surfaces and not noise, 0 ... 1.
  float strength = 0.0F;
  Holder holder = Holder::kMotion;
};

/// All free directions of a match, weakest first. Directions that gravity or the altimeter fix are none of them.
struct Localisability {
  static constexpr float kWeak = 0.5F;  ///< a direction below is weak

  std::array<Direction, 6> directions;
  std::uint8_t count = 0;

  [[nodiscard]] std::size_t weak_count() const {
    std::size_t weak = 0;
    while (weak < count && directions[weak].strength < kWeak) ++weak;
    return weak;
  }
};

}  // namespace isobar
