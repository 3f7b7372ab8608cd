// SPDX-License-Identifier: BSD-3-Clause
// Commands of the MS5611-01BA03 (TE data sheet, "Commands"). The chip has no registers and no identification.
#pragma once

#include <cstddef>
#include <cstdint>

namespace isobar::ms5611 {

inline constexpr std::uint8_t kReadAdc = 0x00;  ///< 3 bytes, most significant first; 0 without a conversion
inline constexpr std::size_t kAdcBytes = 3;
inline constexpr std::uint8_t kReset = 0x1E;
inline constexpr std::uint8_t kConvertPressure = 0x40;     ///< D1; + 2 log2(oversampling / 256)
inline constexpr std::uint8_t kConvertTemperature = 0x50;  ///< D2; the same
inline constexpr std::uint8_t kReadProm = 0xA0;            ///< + 2 n: word n, 2 bytes, most significant first
inline constexpr std::size_t kPromWords = 8;

}  // namespace isobar::ms5611
