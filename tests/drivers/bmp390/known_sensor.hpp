// SPDX-License-Identifier: BSD-3-Clause
// Coefficients of a real BMP388, which has the BMP390's memory and formulas, with a result and its
// compensated values as published by the authors of an independent driver.
#pragma once

#include "drivers/bmp390/compensation.hpp"

namespace isobar::bmp390 {

inline constexpr CoefficientBytes kKnownBytes{0x23, 0x6B, 0x58, 0x49, 0xF6, 0x5C, 0xFF,
                                              0xCE, 0xF4, 0x23, 0x00, 0xEA, 0x63, 0x6E,
                                              0x79, 0xF3, 0xF6, 0xAA, 0x43, 0x12, 0xC4};
inline constexpr std::array<std::uint8_t, kDataBytes> kKnownResult{0x97, 0x9F, 0x6D, 0x73, 0xD8, 0x85};
inline constexpr double kKnownPressurePa = 100'876.00634692199;
inline constexpr double kKnownTemperatureC = 30.499314453874284;

}  // namespace isobar::bmp390
