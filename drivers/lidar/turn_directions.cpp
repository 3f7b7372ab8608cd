// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar/turn_directions.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar {

const std::vector<TurnDirection>& turn_directions() {
  static const std::vector<TurnDirection> directions = [] {
    constexpr double kRadPerCount = kRadPerDeg / 100.0;
    std::vector<TurnDirection> table(kFullTurn);
    for (std::size_t count = 0; count < kFullTurn; ++count) {
      const double azimuth_rad = static_cast<double>(count) * kRadPerCount;
      table[count] = {static_cast<float>(std::cos(azimuth_rad)), -static_cast<float>(std::sin(azimuth_rad))};
    }
    return table;
  }();
  return directions;
}

std::uint32_t turn_count(double degrees) {
  const double turns = degrees / 360.0;
  return static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * kFullTurn)) % kFullTurn;
}

CountLimits::CountLimits(const LidarLimits& limits, double distance_unit_m, std::uint32_t most) {
  // 1e-6 absorbs rounding: 0.3 m / 2 mm is 150.00000000000003.
  min_count = static_cast<std::uint32_t>(
      std::clamp(std::ceil(limits.min_range_m / distance_unit_m - 1e-6), 1.0, static_cast<double>(most)));
  max_count = static_cast<std::uint32_t>(
      std::clamp(std::floor(limits.max_range_m / distance_unit_m + 1e-6), 0.0, static_cast<double>(most)));
  mask_start = turn_count(limits.mask_start_deg);
  mask_width = within_turn(turn_count(limits.mask_end_deg) + kFullTurn - mask_start);
}

}  // namespace isobar
