// SPDX-License-Identifier: BSD-3-Clause
// Conversion of DPS310 registers to pressure and temperature, without I/O.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "drivers/dps310/registers.hpp"

namespace isobar::dps310 {

/// Factory calibration coefficients in the sensor's non-volatile memory.
struct Coefficients {
  std::int32_t c0 = 0;   ///< 12 bit
  std::int32_t c1 = 0;   ///< 12 bit
  std::int32_t c00 = 0;  ///< 20 bit
  std::int32_t c10 = 0;  ///< 20 bit
  std::int32_t c01 = 0;  ///< 16 bit, as all that follow
  std::int32_t c11 = 0;
  std::int32_t c20 = 0;
  std::int32_t c21 = 0;
  std::int32_t c30 = 0;
  bool operator==(const Coefficients&) const = default;
};

using CoefficientBytes = std::array<std::uint8_t, kCoefficientBytes>;

/// Two's complement fields of 12, 20 and 16 bit, most significant bit first (data sheet, "Calibration
/// Coefficients", registers 0x10 … 0x21). Every input decodes; see implausibility().
[[nodiscard]] Coefficients decode_coefficients(const CoefficientBytes& bytes) noexcept;

/// The rule that the coefficients break, a static text; nullptr when none. They have no checksum: the rules
/// detect a memory that is not loaded yet and a bus that reads only zeros or ones.
[[nodiscard]] const char* implausibility(const CoefficientBytes& bytes) noexcept;

/// Raw results, 24 bit two's complement.
struct RawResult {
  std::int32_t pressure = kNoResult;
  std::int32_t temperature = kNoResult;
  bool operator==(const RawResult&) const = default;
};

/// @param bytes registers 0x00 … 0x05
[[nodiscard]] RawResult decode_result(const std::array<std::uint8_t, kResultBytes>& bytes) noexcept;

/// log2 of an oversampling or a rate, 1 … 128: index of the tables below and value of the registers.
[[nodiscard]] constexpr std::uint8_t index_of(int power_of_two) noexcept {
  return static_cast<std::uint8_t>(std::countr_zero(static_cast<unsigned>(power_of_two)));
}

/// Full scale of a result by oversampling (data sheet, "Compensation Scale Factors", kP and kT).
[[nodiscard]] constexpr double scale_factor(int oversampling) noexcept {
  constexpr std::array<double, 8> kScale{524'288, 1'572'864, 3'670'016, 7'864'320,
                                         253'952, 516'096,   1'040'384, 2'088'960};
  return kScale[index_of(oversampling) & 7U];
}

/// Duration of one measurement of pressure or temperature [s], typical (data sheet, "Pressure
/// Configuration").
[[nodiscard]] constexpr double measurement_time_s(int oversampling) noexcept {
  constexpr std::array<double, 8> kTime{3.6e-3,  5.2e-3,  8.4e-3,   14.8e-3,
                                        27.6e-3, 53.2e-3, 104.4e-3, 206.8e-3};
  return kTime[index_of(oversampling) & 7U];
}

/// Noise of one pressure [Pa rms] (same table). The table has no value for 128 times; that of 64 times stands
/// for it, since more averaging is no worse.
[[nodiscard]] constexpr double pressure_noise_pa(int oversampling) noexcept {
  constexpr std::array<double, 8> kNoise{2.5, 1.0, 0.5, 0.4, 0.35, 0.3, 0.2, 0.2};
  return kNoise[index_of(oversampling) & 7U];
}

/// Pressure and temperature after the factory's compensation.
struct Compensated {
  double pressure_pa = 0.0;
  double temperature_c = 0.0;
};

/// The data sheet's formulas, "How to Calculate Compensated Pressure Values" and "… Temperature Values":
///   T = c0/2 + c1 Ts,  p = c00 + Ps (c10 + Ps (c20 + Ps c30)) + Ts c01 + Ts Ps (c11 + Ps c21)
/// with Ps and Ts the results over their full scales. Finite for every input.
[[nodiscard]] Compensated compensate(const Coefficients& coefficients, const RawResult& raw,
                                     double pressure_scale, double temperature_scale) noexcept;

/// The rule that a result breaks, a static text; nullptr when there is a result and it lies in the operating
/// range of the data sheet, 300 … 1200 hPa and -40 … 85 degrees C.
[[nodiscard]] const char* implausibility(const RawResult& raw, const Compensated& value) noexcept;

}  // namespace isobar::dps310
