// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/bmp390/chip_model.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::bmp390 {

namespace {

/// CRC-8 as a division of a polynomial, bit by bit: the message, then 8 zeros; the start value inverts the
/// first 8 bits.
std::uint8_t divided(const CoefficientBytes& bytes) {
  std::array<bool, 8 * (kCoefficientBytes + 1)> bits{};
  for (std::size_t i = 0; i < 8 * kCoefficientBytes; ++i) {
    bits[i] = (bytes[i / 8] >> (7 - i % 8) & 1) != 0;
    if (i < 8) bits[i] = !bits[i];
  }
  constexpr std::array<bool, 9> kDivisor{true, false, false, false, true, true, true, false, true};
  for (std::size_t i = 0; i + 8 < bits.size(); ++i) {
    if (!bits[i]) continue;
    for (std::size_t k = 0; k < kDivisor.size(); ++k) bits[i + k] = bits[i + k] != kDivisor[k];
  }
  unsigned rest = 0;
  for (std::size_t i = bits.size() - 8; i < bits.size(); ++i) rest = rest << 1U | (bits[i] ? 1U : 0U);
  return static_cast<std::uint8_t>(rest ^ 0xFFU);
}

}  // namespace

void ChipModel::power_up() {
  registers_.fill(0);
  for (const unsigned address : {0x06U, 0x09U}) registers_[address] = 0x80;
  registers_[0x10] = 0x01;  // EVENT.por_detected
  registers_[0x1C] = 0x02;
  std::copy(coefficients.begin(), coefficients.end(), registers_.begin() + 0x31);
  registers_[0x30] = divided(kKnownBytes);  // fixed by the factory
  start_ns_ = now_ns();
  ends_ns_ = kNever;
}

double ChipModel::busy_s() const {
  const double samples = (1 << (registers_[0x1C] & 7)) + (1 << (registers_[0x1C] >> 3 & 7));
  return 1e-6 * (234.0 + 392.0 + 163.0 + 2'020.0 * samples);  // data sheet 3.9.2
}

double ChipModel::period_s() const { return 5e-3 * (1 << (registers_[0x1D] & 31)); }

void ChipModel::happen() {
  if (!stops) {
    const double pa = air_pa((begun_ns_ + ends_ns_) / 2);
    if (!frozen) newest_pressure_ = raw_pressure(pa);
    store(0x04, newest_pressure_);
    store(0x07, raw_temperature());
    registers_[0x03] |= 0x60;
  }
  begun_ns_ += duration_ns(period_s());
  ends_ns_ = begun_ns_ + duration_ns(busy_s());
}

/// Data sheet 8.5, solved for the result by Newton's method.
std::uint32_t ChipModel::raw_temperature() const {
  const double t1 = 27'427.0 * 256.0;
  const double t2 = 18'776.0 / std::pow(2.0, 30);
  const double t3 = -10.0 / std::pow(2.0, 48);
  double d = 0.0;
  for (int i = 0; i < 10; ++i) d -= (d * t2 + d * d * t3 - temperature_c) / (t2 + 2.0 * d * t3);
  return static_cast<std::uint32_t>(std::lround(t1 + d));
}

/// Data sheet 8.6, solved for the result.
std::uint32_t ChipModel::raw_pressure(double wanted_pa) const {
  const double t = temperature_c;
  const auto two = [](int exponent) { return std::pow(2.0, exponent); };
  const double out1 =
      25'578.0 * 8.0 + 31'086.0 / 64.0 * t + -13.0 / 256.0 * t * t + -10.0 / 32'768.0 * t * t * t;
  const double per_up =
      (-164.0 - 16'384.0) / two(20) + (-2'866.0 - 16'384.0) / two(29) * t + 35.0 / two(32) * t * t;
  const double per_up2 = 17'322.0 / two(48) + 18.0 / two(48) * t;
  const double per_up3 = -60.0 / two(65);
  double up = 7e6;
  for (int i = 0; i < 20; ++i) {
    const double p = out1 + up * per_up + up * up * per_up2 + up * up * up * per_up3;
    up -= (p - wanted_pa) / (per_up + 2.0 * up * per_up2 + 3.0 * up * up * per_up3);
  }
  return static_cast<std::uint32_t>(std::lround(std::clamp(up, 0.0, 16'777'215.0)));
}

void ChipModel::store(unsigned address, std::uint32_t value) {
  for (unsigned i = 0; i < 3; ++i) registers_[address + i] = static_cast<std::uint8_t>(value >> (8 * i));
  if (address == 0x04) pressures.insert(value);
}

void ChipModel::begin_read(std::uint8_t first) {
  pointer_ = first;
  for (unsigned i = 0; i < 6; ++i) shadow_[i] = registers_[0x04 + i];
}

std::uint8_t ChipModel::next_byte() {
  const std::uint8_t address = pointer_++;
  if (address >= 0x04 && address <= 0x09) {
    registers_[0x03] &= static_cast<std::uint8_t>(address <= 0x06 ? ~0x20 : ~0x40);
    return shadow_[address - 0x04U];
  }
  switch (address) {
    case 0x00:
      return id_;
    case 0x02:
      return busy_s() > period_s() ? 0x04 : 0x00;
    case 0x03:
      return registers_[address] | 0x10;
    default:
      return registers_[address];
  }
}

void ChipModel::take(std::uint8_t address, std::uint8_t value) {
  switch (address) {
    case 0x7E:
      if (value == 0xB6) {
        ++soft_resets;
        power_up();
      }
      break;
    case 0x1B:
      registers_[address] = value;
      begun_ns_ = now_ns();
      ends_ns_ = value == 0x33 ? begun_ns_ + duration_ns(busy_s()) : kNever;
      break;
    case 0x1C:
    case 0x1D:
    case 0x1F:
      registers_[address] = value;
      break;
    default:
      break;
  }
}

}  // namespace isobar::bmp390
