// SPDX-License-Identifier: BSD-3-Clause
// Conversion of BMP390 registers to pressure and temperature, without I/O.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "drivers/barometer/bits.hpp"
#include "drivers/bmp390/registers.hpp"

namespace isobar::bmp390 {

/// Factory calibration, scaled to floating point (data sheet 8.4).
struct Coefficients {
  std::array<double, 3> t{};   ///< PAR_T1 … PAR_T3
  std::array<double, 11> p{};  ///< PAR_P1 … PAR_P11
};

using CoefficientBytes = std::array<std::uint8_t, kCoefficientBytes>;

/// Registers 0x31 … 0x45 (data sheet 3.11.1 table "memory map trimming coefficients"). Every input decodes;
/// see implausibility().
[[nodiscard]] Coefficients decode_coefficients(const CoefficientBytes& bytes) noexcept;

/// CRC-8 of the coefficients, which the chip holds in register 0x30: polynomial 0x1D, start and final
/// inversion 0xFF. Not in the data sheet: from the self-test of Bosch's public driver.
[[nodiscard]] std::uint8_t coefficient_crc(const CoefficientBytes& bytes) noexcept;

/// The rule that the coefficients break, a static text; nullptr when none.
[[nodiscard]] const char* implausibility(const CoefficientBytes& bytes, std::uint8_t crc) noexcept;

/// Content of the data registers, 24 bit.
struct RawResult {
  std::uint32_t pressure = kNoResult;
  std::uint32_t temperature = kNoResult;
};

[[nodiscard]] RawResult decode_result(std::span<const std::uint8_t, kDataBytes> bytes) noexcept;

struct Compensated {
  double pressure_pa = 0.0;
  double temperature_c = 0.0;
};

/// Data sheet 8.5 and 8.6. Finite for every input.
[[nodiscard]] Compensated compensate(const Coefficients& coefficients, const RawResult& raw) noexcept;

/// The rule that a result breaks, a static text; nullptr when there is a result and it lies in the operating
/// range.
[[nodiscard]] const char* implausibility(const RawResult& raw, const Compensated& value) noexcept;

/// Duration of a measurement of pressure and temperature by oversampling, 1 … 32 [s], typical (data sheet
/// 3.9.2).
[[nodiscard]] constexpr double measurement_time_s(int pressure_oversampling,
                                                  int temperature_oversampling) noexcept {
  return 1e-6 * (234 + 392 + 2'020 * pressure_oversampling + 163 + 2'020 * temperature_oversampling);
}

/// Noise of one pressure without filter [Pa rms]. The data sheet gives the one at the highest oversampling,
/// 0.9 Pa at 32 times (table 2); the others are that of fewer averaged samples.
[[nodiscard]] inline double pressure_noise_pa(int oversampling) noexcept {
  return 0.9 * std::sqrt(32.0 / oversampling);
}

}  // namespace isobar::bmp390
