// SPDX-License-Identifier: BSD-3-Clause
// The worked examples of the MS5611's data sheet (page 8) and of application note AN520.
#pragma once

#include "drivers/ms5611/compensation.hpp"

namespace isobar::ms5611 {

/// C1 … C6 of the data sheet, without a CRC; see sealed().
inline constexpr Prom kKnownProm{0x0000, 40'127, 36'924, 23'317, 23'282, 33'464, 28'312, 0x4500};
inline constexpr RawResult kExampleResult{9'085'466, 8'569'150};
inline constexpr double kKnownTemperatureC = 20.07;
inline constexpr double kKnownPressurePa = 100'009.0;

/// AN520: the CRC of this memory is 0xB.
inline constexpr Prom kNoteProm{0x3132, 0x3334, 0x3536, 0x3738, 0x3940, 0x4142, 0x4344, 0x450B};

/// CRC-4 as a division of a polynomial, bit by bit: the 15 bytes before that of the CRC, then 4 zeros, by x^4
/// + x + 1.
inline std::uint8_t divided_crc4(const Prom& prom) {
  constexpr std::size_t kMessage = 16 * kPromWords - 8;
  std::array<bool, kMessage + 4> bits{};
  for (std::size_t i = 0; i < kMessage; ++i) bits[i] = (prom[i / 16] >> (15 - i % 16) & 1) != 0;
  constexpr std::array<bool, 5> kDivisor{true, false, false, true, true};
  for (std::size_t i = 0; i + 4 < bits.size(); ++i) {
    if (!bits[i]) continue;
    for (std::size_t k = 0; k < kDivisor.size(); ++k) bits[i + k] = bits[i + k] != kDivisor[k];
  }
  unsigned rest = 0;
  for (std::size_t i = bits.size() - 4; i < bits.size(); ++i) rest = rest << 1U | (bits[i] ? 1U : 0U);
  return static_cast<std::uint8_t>(rest);
}

/// A memory with its CRC.
inline Prom sealed(Prom prom) {
  prom.back() = static_cast<std::uint16_t>((prom.back() & 0xFFF0U) | divided_crc4(prom));
  return prom;
}

}  // namespace isobar::ms5611
