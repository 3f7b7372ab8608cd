// SPDX-License-Identifier: BSD-3-Clause
// Conversion of BMP581 registers to pressure and temperature, without I/O. The chip compensates itself.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/barometer/bits.hpp"
#include "drivers/bmp581/registers.hpp"

namespace isobar::bmp581 {

/// Content of the data registers, 24 bit.
struct RawResult {
  std::int32_t temperature = 0;  ///< two's complement
  std::uint32_t pressure = 0;
};

[[nodiscard]] RawResult decode_result(std::span<const std::uint8_t, kDataBytes> bytes) noexcept;

struct Converted {
  double pressure_pa = 0.0;
  double temperature_c = 0.0;
};

/// Data sheet 4.5 "Data registers": T = raw / 2^16 degrees C, p = raw / 2^6 Pa.
[[nodiscard]] Converted convert(const RawResult& raw) noexcept;

/// The rule that a result breaks, a static text; nullptr when there is a result and it lies in the operating
/// range.
[[nodiscard]] const char* implausibility(const RawResult& raw, const Converted& value) noexcept;

/// Duration of a pressure measurement by oversampling, 1 … 128 [s], typical (data sheet table 2, t_conv_p).
[[nodiscard]] constexpr double pressure_time_s(int oversampling) noexcept {
  constexpr std::array<double, 8> kTime{1.0e-3, 1.7e-3, 2.9e-3, 5.4e-3, 10.4e-3, 20.4e-3, 40.4e-3, 80.4e-3};
  return kTime[index_of_power(oversampling) & 7U];
}

/// The same of a temperature measurement (t_conv_t).
[[nodiscard]] constexpr double temperature_time_s(int oversampling) noexcept {
  constexpr std::array<double, 8> kTime{1.0e-3, 1.1e-3, 1.5e-3, 2.1e-3, 3.3e-3, 5.8e-3, 10.8e-3, 20.8e-3};
  return kTime[index_of_power(oversampling) & 7U];
}

/// Noise of one pressure [Pa rms] at 100 kPa (data sheet table 9).
[[nodiscard]] constexpr double pressure_noise_pa(int oversampling) noexcept {
  constexpr std::array<double, 8> kNoise{0.78, 0.58, 0.41, 0.30, 0.21, 0.15, 0.11, 0.08};
  return kNoise[index_of_power(oversampling) & 7U];
}

/// A rate of normal mode and its code in ODR_CONFIG.
struct Rate {
  int hz = 0;
  std::uint8_t code = 0;
};

/// Rates of the chip that are whole numbers to 0.5 % (data sheet, register ODR_CONFIG).
inline constexpr std::array<Rate, 16> kRates{{{1, 0x1C},
                                              {2, 0x1B},
                                              {3, 0x1A},
                                              {4, 0x19},
                                              {5, 0x18},
                                              {10, 0x17},
                                              {15, 0x16},
                                              {20, 0x15},
                                              {25, 0x14},
                                              {30, 0x13},
                                              {40, 0x11},
                                              {50, 0x0F},
                                              {80, 0x0C},
                                              {100, 0x0A},
                                              {120, 0x08},
                                              {160, 0x04}}};

/// Code of a rate in kRates; that of the slowest for any other.
[[nodiscard]] std::uint8_t rate_code(int rate_hz) noexcept;

}  // namespace isobar::bmp581
