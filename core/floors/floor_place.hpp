// SPDX-License-Identifier: BSD-3-Clause
// Where a robot is with regard to the floors of a building.
#pragma once

#include <cstdint>

#include "core/name_table.hpp"

namespace isobar {

enum class FloorPlace : std::uint8_t {
  kUnknown,    ///< no floors are known yet, or the height is too uncertain to tell them apart
  kOnFloor,    ///< on a floor
  kHalfLevel,  ///< on a level that is no floor of its own: a landing, a split level, a mezzanine
  kBetween,    ///< on none: a ramp, stairs, an elevator, or a floor that is not driven yet
};

inline constexpr NameTable<FloorPlace, 4> kFloorPlaceTexts{{{
    {FloorPlace::kUnknown, "not known"},
    {FloorPlace::kOnFloor, "on a floor"},
    {FloorPlace::kHalfLevel, "on a half level"},
    {FloorPlace::kBetween, "between floors"},
}}};

}  // namespace isobar
