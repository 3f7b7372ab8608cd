// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/lidar/lidar_decoder.hpp"

namespace isobar {

/// Direction of a beam in the sensor's x-y plane.
struct TurnDirection {
  float x;
  float y;
};

/// Directions by azimuth [0.01 deg], kFullTurn of them; y is to the left, azimuth clockwise from above.
[[nodiscard]] const std::vector<TurnDirection>& turn_directions();

/// azimuth mod kFullTurn for azimuths below two turns, without a division: one for each return would double
/// the decoder's cost.
[[nodiscard]] constexpr std::uint32_t within_turn(std::uint32_t azimuth) {
  return azimuth >= kFullTurn ? azimuth - kFullTurn : azimuth;
}

/// Count of an angle [0.01 deg], below kFullTurn.
[[nodiscard]] std::uint32_t turn_count(double degrees);

/// Ranges and masked sector in the units of a packet.
struct CountLimits {
  std::uint32_t min_count = 1;
  std::uint32_t max_count = 0;
  std::uint32_t mask_start = 0;
  std::uint32_t mask_width = 0;

  CountLimits() = default;
  /// @param most largest count that the packet can hold
  CountLimits(const LidarLimits& limits, double distance_unit_m, std::uint32_t most);

  [[nodiscard]] bool keeps(std::uint32_t count, std::uint32_t azimuth) const {
    const bool masked = within_turn(azimuth + kFullTurn - mask_start) < mask_width;
    return count >= min_count && count <= max_count && !masked;
  }
};

}  // namespace isobar
