// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bmp390/compensation.hpp"

#include <algorithm>

#include "drivers/barometer/operating_range.hpp"

namespace isobar::bmp390 {

Coefficients decode_coefficients(const CoefficientBytes& bytes) noexcept {
  const auto u16 = [&](std::size_t at) { return static_cast<double>(little_u16(bytes, at)); };
  const auto s16 = [&](std::size_t at) {
    return static_cast<double>(signed_field(little_u16(bytes, at), 16));
  };
  const auto s8 = [&](std::size_t at) { return static_cast<double>(signed_field(bytes[at], 8)); };
  const auto scaled = [](double value, int exponent) { return std::ldexp(value, exponent); };
  constexpr double kOffset = 16'384.0;  // 2^14
  Coefficients c;
  c.t = {scaled(u16(0), 8), scaled(u16(2), -30), scaled(s8(4), -48)};
  c.p = {scaled(s16(5) - kOffset, -20),
         scaled(s16(7) - kOffset, -29),
         scaled(s8(9), -32),
         scaled(s8(10), -37),
         scaled(u16(11), 3),
         scaled(u16(13), -6),
         scaled(s8(15), -8),
         scaled(s8(16), -15),
         scaled(s16(17), -48),
         scaled(s8(19), -48),
         scaled(s8(20), -65)};
  return c;
}

std::uint8_t coefficient_crc(const CoefficientBytes& bytes) noexcept {
  constexpr unsigned kPolynomial = 0x1D;
  unsigned crc = 0xFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U) != 0 ? crc << 1U ^ kPolynomial : crc << 1U;
    crc &= 0xFFU;
  }
  return static_cast<std::uint8_t>(~crc);
}

const char* implausibility(const CoefficientBytes& bytes, std::uint8_t crc) noexcept {
  if (std::all_of(bytes.begin(), bytes.end(), [&](std::uint8_t byte) { return byte == bytes.front(); })) {
    return "all bytes of the coefficients are equal";
  }
  return crc == coefficient_crc(bytes) ? nullptr : "the coefficients do not fit their checksum";
}

RawResult decode_result(std::span<const std::uint8_t, kDataBytes> bytes) noexcept {
  return {little_u24(bytes, 0), little_u24(bytes, 3)};
}

Compensated compensate(const Coefficients& c, const RawResult& raw) noexcept {
  const double dt = raw.temperature - c.t[0];
  const double t = dt * c.t[1] + dt * dt * c.t[2];
  const double up = raw.pressure;
  const double offset = c.p[4] + t * (c.p[5] + t * (c.p[6] + t * c.p[7]));
  const double slope = c.p[0] + t * (c.p[1] + t * (c.p[2] + t * c.p[3]));
  const double square = c.p[8] + t * c.p[9];
  return {offset + up * (slope + up * (square + up * c.p[10])), t};
}

const char* implausibility(const RawResult& raw, const Compensated& value) noexcept {
  if (raw.pressure == kNoResult || raw.temperature == kNoResult) return "no result in the registers";
  return outside_operation(value.pressure_pa, value.temperature_c);
}

}  // namespace isobar::bmp390
