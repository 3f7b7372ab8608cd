// SPDX-License-Identifier: BSD-3-Clause
// Conversion of ICP-20100 results to pressure and temperature, without I/O. The chip compensates itself.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/icp20100/registers.hpp"

namespace isobar::icp20100 {

/// A result of the FIFO, 20 bit two's complement.
struct RawResult {
  std::int32_t pressure = 0;
  std::int32_t temperature = 0;
};

[[nodiscard]] RawResult decode_result(std::span<const std::uint8_t, kResultBytes> bytes) noexcept;

struct Converted {
  double pressure_pa = 0.0;
  double temperature_c = 0.0;
};

/// Data sheet 6.7 "Pressure and temperature data": p = raw / 2^17 * 40 kPa + 70 kPa, T = raw / 2^18 * 65 + 25
/// degrees C.
[[nodiscard]] Converted convert(const RawResult& raw) noexcept;

/// The rule that a result breaks, a static text; nullptr when there is a result and it lies in the operating
/// range.
[[nodiscard]] const char* implausibility(const RawResult& raw, const Converted& value) noexcept;

/// Measurement configuration of MODE_SELECT (data sheet table 5). The bandwidth is that of the chip's FIR
/// filter, which is always on in these modes.
struct Mode {
  int rate_hz = 0;
  std::uint8_t number = 0;
  double bandwidth_hz = 0.0;
  double noise_pa = 0.0;  ///< rms of one result
};

inline constexpr std::array<Mode, 3> kModes{{{25, 0, 6.25, 0.5}, {40, 2, 10.0, 1.0}, {120, 1, 30.0, 1.0}}};

/// The mode of a rate in kModes; the slowest for any other.
[[nodiscard]] const Mode& mode_of(int rate_hz) noexcept;

/// Variance of white noise with the same density as the filtered noise of a mode [Pa^2]: neighbouring results
/// share the filter's samples, so that taken as independent they would count for more than they know.
[[nodiscard]] double white_variance_pa2(const Mode& mode) noexcept;

/// Results until the FIR filter has settled (data sheet 6.3): those before are of no use.
inline constexpr int kSettlingResults = 14;

}  // namespace isobar::icp20100
