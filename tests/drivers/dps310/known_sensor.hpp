// SPDX-License-Identifier: BSD-3-Clause
// Coefficients of a real DPS310 and their bytes, encoded by hand from the data sheet's table.
#pragma once

#include "drivers/dps310/compensation.hpp"

namespace isobar::dps310 {

inline constexpr Coefficients kKnownCoefficients{220, -293, 78'668, -47'847, -2'565, 1'250, -7'393, 67, -852};

// 220 = 0x0DC, -293 = 0xEDB (12 bit); 78668 = 0x1334C, -47847 = 0xF4519 (20 bit); -2565 = 0xF5FB, 1250 =
// 0x04E2, -7393 = 0xE31F, 67 = 0x0043, -852 = 0xFCAC (16 bit).
inline constexpr CoefficientBytes kKnownBytes{0x0D, 0xCE, 0xDB, 0x13, 0x34, 0xCF, 0x45, 0x19, 0xF5,
                                              0xFB, 0x04, 0xE2, 0xE3, 0x1F, 0x00, 0x43, 0xFC, 0xAC};

}  // namespace isobar::dps310
