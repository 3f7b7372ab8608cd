// SPDX-License-Identifier: BSD-3-Clause
// Grid of the search for a place: cells seen from above, headings, and levels of height above base_link.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace isobar {

inline constexpr float kPlaceCellM = 0.2F;  ///< edge of a cell seen from above
inline constexpr int kYawSteps = 1024;      ///< headings of the search: 0.35 degrees apart
/// Farther points do not take part in the search, but in the choice among its hypotheses [m].
inline constexpr float kViewRangeM = 64.0F;
/// Points farther from the robot do not take part in the search [m]: up to there one step of heading moves a point by one cell.
inline constexpr float kPlaceRangeM = 32.0F;
static_assert(kPlaceRangeM * 2.0F * std::numbers::pi_v<float> < kYawSteps * kPlaceCellM);

inline constexpr int kHeightLevels = 16;
inline constexpr float kHeightLevelM = 0.2F;
inline constexpr float kLowestLevelM = -0.2F;  ///< lower edge of level 0, above base_link

/// Index of the cell of a coordinate [m]; |coordinate| < 1e8 m.
[[nodiscard]] inline int place_cell(double coordinate_m) {
  return static_cast<int>(std::floor(coordinate_m / static_cast<double>(kPlaceCellM)));
}

/// Bit of the level of a height above base_link [m]; 0 where no level holds it.
[[nodiscard]] inline std::uint16_t height_bit(float above_base_m) {
  const float level = std::floor((above_base_m - kLowestLevelM) / kHeightLevelM);
  if (!(level >= 0.0F && level < static_cast<float>(kHeightLevels))) return 0;
  return static_cast<std::uint16_t>(1U << static_cast<unsigned>(level));
}

/// The levels and those beside them: the altimeter's error moves surfaces by one.
[[nodiscard]] inline std::uint16_t with_neighbours(std::uint16_t levels) {
  const auto bits = static_cast<unsigned>(levels);
  return static_cast<std::uint16_t>(bits | bits << 1U | bits >> 1U);
}

/// Heights of walls that the search compares [m above base_link]: below are the ground and kerbs, above are ceilings.
inline constexpr float kWallLowM = 0.3F;
inline constexpr float kWallHighM = 2.5F;

}  // namespace isobar
