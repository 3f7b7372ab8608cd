// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ms5611/compensation.hpp"

#include <cstddef>

#include "drivers/barometer/operating_range.hpp"

namespace isobar::ms5611 {

std::uint8_t crc4(const Prom& prom) noexcept {
  constexpr unsigned kPolynomial = 0x3000;  // in the uppermost 4 of 16 bits
  constexpr unsigned kTop = 0x8000;
  unsigned rest = 0;
  for (std::size_t i = 0; i < 2 * kPromWords; ++i) {
    const unsigned word = i / 2 + 1 == kPromWords ? prom[i / 2] & 0xFF00U : prom[i / 2];
    rest ^= i % 2 == 0 ? word >> 8U : word & 0xFFU;
    for (int bit = 0; bit < 8; ++bit) rest = (rest & kTop) != 0 ? rest << 1U ^ kPolynomial : rest << 1U;
    rest &= 0xFFFFU;
  }
  return static_cast<std::uint8_t>(rest >> 12U);
}

const char* implausibility(const Prom& prom) noexcept {
  for (std::size_t i = 1; i <= 6; ++i) {
    if (prom[i] == 0 || prom[i] == 0xFFFF) return "a coefficient of the memory is empty: another device?";
  }
  if (crc4(prom) != (prom.back() & 0x0FU)) {
    return "the coefficients do not fit their checksum: another device?";
  }
  return nullptr;
}

Compensated compensate(const Prom& c, const RawResult& raw) noexcept {
  // Temperatures in 0.01 degrees C and pressures in 0.01 mbar = 1 Pa, as in the data sheet.
  const double dt = raw.temperature - c[5] * 256.0;
  double temperature = 2'000.0 + dt * c[6] / 8'388'608.0;
  double offset = c[2] * 65'536.0 + c[4] * dt / 128.0;
  double sensitivity = c[1] * 32'768.0 + c[3] * dt / 256.0;
  if (temperature < 2'000.0) {
    const double below = (temperature - 2'000.0) * (temperature - 2'000.0);
    double offset2 = 2.5 * below;
    double sensitivity2 = 1.25 * below;
    if (temperature < -1'500.0) {
      const double cold = (temperature + 1'500.0) * (temperature + 1'500.0);
      offset2 += 7.0 * cold;
      sensitivity2 += 5.5 * cold;
    }
    temperature -= dt * dt / 2'147'483'648.0;
    offset -= offset2;
    sensitivity -= sensitivity2;
  }
  return {(raw.pressure * sensitivity / 2'097'152.0 - offset) / 32'768.0, temperature / 100.0};
}

const char* implausibility(const RawResult& raw, const Compensated& value) noexcept {
  if (raw.pressure == 0 || raw.temperature == 0) return "no result in the converter";
  return outside_operation(value.pressure_pa, value.temperature_c);
}

}  // namespace isobar::ms5611
