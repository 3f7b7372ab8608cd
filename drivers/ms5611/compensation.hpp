// SPDX-License-Identifier: BSD-3-Clause
// Conversion of MS5611 results to pressure and temperature, without I/O.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/barometer/bits.hpp"
#include "drivers/ms5611/commands.hpp"

namespace isobar::ms5611 {

/// Words of the factory's memory: reserved, C1 … C6, serial number and CRC-4.
using Prom = std::array<std::uint16_t, kPromWords>;

/// CRC-4 of a memory (application note AN520): polynomial x^4 + x + 1 over the bytes before the last one.
/// Equal to the lowest 4 bits of the last word in a sound memory.
[[nodiscard]] std::uint8_t crc4(const Prom& prom) noexcept;

/// The rule that a memory breaks, a static text; nullptr when none. The CRC is all that identifies the chip.
[[nodiscard]] const char* implausibility(const Prom& prom) noexcept;

/// Results of the converter, 24 bit.
struct RawResult {
  std::uint32_t pressure = 0;     ///< D1
  std::uint32_t temperature = 0;  ///< D2
};

struct Compensated {
  double pressure_pa = 0.0;
  double temperature_c = 0.0;
};

/// Data sheet, "Pressure and temperature calculation", and below 20 degrees C "Second order temperature
/// compensation", in floating point: the integer formulas truncate to 0.01 mbar, 8 cm. Finite for every
/// input.
[[nodiscard]] Compensated compensate(const Prom& prom, const RawResult& raw) noexcept;

/// The rule that a result breaks, a static text; nullptr when there is a result and it lies in the operating
/// range.
[[nodiscard]] const char* implausibility(const RawResult& raw, const Compensated& value) noexcept;

/// Index of an oversampling, 256 … 4096, in the tables and commands.
[[nodiscard]] constexpr std::uint8_t oversampling_index(int oversampling) noexcept {
  const int index = index_of_power(oversampling) - 8;
  return static_cast<std::uint8_t>(index < 0 ? 0 : index > 4 ? 4 : index);
}

/// Longest duration of a conversion by oversampling [s] (data sheet, "Analog digital converter").
[[nodiscard]] constexpr double longest_conversion_s(int oversampling) noexcept {
  constexpr std::array<double, 5> kTime{0.60e-3, 1.17e-3, 2.28e-3, 4.54e-3, 9.04e-3};
  return kTime[oversampling_index(oversampling)];
}

/// Typical duration, for the stamp.
[[nodiscard]] constexpr double conversion_s(int oversampling) noexcept {
  constexpr std::array<double, 5> kTime{0.54e-3, 1.06e-3, 2.08e-3, 4.13e-3, 8.22e-3};
  return kTime[oversampling_index(oversampling)];
}

/// Noise of one pressure [Pa rms] (data sheet, "Sensor performances", resolution).
[[nodiscard]] constexpr double pressure_noise_pa(int oversampling) noexcept {
  constexpr std::array<double, 5> kNoise{6.5, 4.2, 2.7, 1.8, 1.2};
  return kNoise[oversampling_index(oversampling)];
}

}  // namespace isobar::ms5611
