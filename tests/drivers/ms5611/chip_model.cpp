// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/ms5611/chip_model.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::ms5611 {

void ChipModel::power_up() {
  loaded_ = false;
  ends_ns_ = kNever;
  converter_ = 0;
  reset_ns_ = now_ns();
}

void ChipModel::spoil() {
  if (ends_ns_ == kNever) return;
  ++spoiled;
  ends_ns_ = kNever;
  converter_ = 0;
}

void ChipModel::obey(std::uint8_t code) {
  constexpr std::array<double, 5> kTypical{0.54e-3, 1.06e-3, 2.08e-3, 4.13e-3, 8.22e-3};
  spoil();
  if (code == 0x1E) {
    ++soft_resets;
    loaded_ = true;
    reset_ns_ = now_ns();
    converter_ = 0;
  } else if ((code & 0xE1) == 0x40 && (code >> 1 & 7) < 5) {
    converting_pressure_ = (code & 0x10) == 0;
    begun_ns_ = now_ns();
    ends_ns_ = begun_ns_ + duration_ns(kTypical[code >> 1 & 7U]);
  }
}

void ChipModel::happen() {
  const std::int64_t middle_ns = (begun_ns_ + ends_ns_) / 2;
  ends_ns_ = kNever;
  if (stops) return;
  const double raw = converting_pressure_ ? raw_pressure(air_pa(middle_ns)) : raw_temperature();
  // Without its coefficients the converter is not set up: any number.
  converter_ =
      static_cast<std::uint32_t>(std::lround(std::clamp(loaded_ ? raw : 0.97 * raw, 0.0, 16'777'215.0)));
  if (!converting_pressure_) return;
  if (frozen) converter_ = frozen_pressure_;
  frozen_pressure_ = converter_;
}

/// Data sheet, first order, solved for D2: dT = D2 - C5 2^8, TEMP = 2000 + dT C6 / 2^23. From 20 degrees on.
double ChipModel::raw_temperature() const {
  return kKnownProm[5] * 256.0 + (100.0 * temperature_c - 2'000.0) * 8'388'608.0 / kKnownProm[6];
}

/// Solved for D1: P = (D1 SENS / 2^21 - OFF) / 2^15.
double ChipModel::raw_pressure(double wanted_pa) const {
  const double dt = raw_temperature() - kKnownProm[5] * 256.0;
  const double offset = kKnownProm[2] * 65'536.0 + kKnownProm[4] * dt / 128.0;
  const double sensitivity = kKnownProm[1] * 32'768.0 + kKnownProm[3] * dt / 256.0;
  return (wanted_pa * 32'768.0 + offset) * 2'097'152.0 / sensitivity;
}

void ChipModel::begin_read(std::uint8_t first) {
  answer_ = 0;
  if (first == 0x00) {
    spoil();
    answer_ = converter_ << 8U;
    converter_ = 0;
  } else if (first >= 0xA0 && first <= 0xAE && first % 2 == 0 && loaded_) {
    answer_ = static_cast<std::uint32_t>(prom[(first - 0xA0U) / 2]) << 16U;
  }
}

std::uint8_t ChipModel::next_byte() {
  const auto byte = static_cast<std::uint8_t>(answer_ >> 24U);
  answer_ <<= 8U;
  return byte;
}

}  // namespace isobar::ms5611
