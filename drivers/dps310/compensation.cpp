// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dps310/compensation.hpp"

#include <algorithm>

#include "drivers/barometer/bits.hpp"
#include "drivers/barometer/operating_range.hpp"

namespace isobar::dps310 {

namespace {

/// `bits` bits of a row of bytes, from bit `first` on, most significant first.
std::int32_t field(std::span<const std::uint8_t> bytes, int first, int bits) {
  std::uint32_t word = 0;
  for (int bit = first; bit < first + bits; ++bit) {
    const auto byte = static_cast<std::size_t>(bit / 8);
    word = word << 1U | (static_cast<std::uint32_t>(bytes[byte]) >> (7 - bit % 8) & 1U);
  }
  return signed_field(word, bits);
}

}  // namespace

Coefficients decode_coefficients(const CoefficientBytes& bytes) noexcept {
  Coefficients c;
  int at = 0;
  const auto take = [&](std::int32_t& to, int bits) {
    to = field(bytes, at, bits);
    at += bits;
  };
  take(c.c0, 12);
  take(c.c1, 12);
  take(c.c00, 20);
  take(c.c10, 20);
  take(c.c01, 16);
  take(c.c11, 16);
  take(c.c20, 16);
  take(c.c21, 16);
  take(c.c30, 16);
  return c;
}

const char* implausibility(const CoefficientBytes& bytes) noexcept {
  if (std::all_of(bytes.begin(), bytes.end(), [&](std::uint8_t byte) { return byte == bytes.front(); })) {
    return "all bytes of the coefficients are equal";
  }
  const Coefficients c = decode_coefficients(bytes);
  if (c.c1 == 0 || c.c10 == 0) return "coefficient c1 or c10 is zero";
  return nullptr;
}

RawResult decode_result(const std::array<std::uint8_t, kResultBytes>& bytes) noexcept {
  return {field(bytes, 0, 24), field(bytes, 24, 24)};
}

Compensated compensate(const Coefficients& c, const RawResult& raw, double pressure_scale,
                       double temperature_scale) noexcept {
  const double ps = raw.pressure / pressure_scale;
  const double ts = raw.temperature / temperature_scale;
  return {c.c00 + ps * (c.c10 + ps * (c.c20 + ps * c.c30)) + ts * c.c01 + ts * ps * (c.c11 + ps * c.c21),
          0.5 * c.c0 + c.c1 * ts};
}

const char* implausibility(const RawResult& raw, const Compensated& value) noexcept {
  if (raw.pressure == kNoResult || raw.temperature == kNoResult) return "no result in the registers";
  return outside_operation(value.pressure_pa, value.temperature_c);
}

}  // namespace isobar::dps310
