// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/bmp581/chip_model.hpp"

#include <cmath>

namespace isobar::bmp581 {

namespace {

/// Data sheet, register ODR_CONFIG, by code [Hz].
constexpr std::array<double, 32> kOdrHz{240,    218.537, 199.111, 179.2, 160,    149.333, 140,  129.855,
                                        120,    110.164, 100.299, 89.6,  80,     70,      60,   50.056,
                                        45.025, 40,      35,      30,    25.005, 20,      15,   10,
                                        5,      4,       3,       2,     1,      0.5,     0.25, 0.125};
/// Data sheet table 9: typical ODR in continuous mode by osr_p [Hz], with temperature oversamplings 1 1 1 1 1
/// 2 4 8. Its inverse is the duration of both measurements.
constexpr std::array<double, 8> kContinuousHz{498, 374, 255, 155, 87, 46, 24, 12};

}  // namespace

void ChipModel::power_up() {
  registers_.fill(0);
  for (unsigned address = 0x1D; address <= 0x22; ++address) registers_[address] = 0x7F;
  registers_[0x27] = 0x10;  // INT_STATUS.por
  registers_[0x30] = 0x23;
  registers_[0x37] = 0x70;
  start_ns_ = now_ns();
  ends_ns_ = kNever;
  has_filtered_ = false;
}

double ChipModel::busy_s() const {
  const unsigned osr_p = registers_[0x36] >> 3 & 7U;
  const unsigned osr_t = registers_[0x36] & 7U;
  const unsigned paired_t = osr_p > 4 ? osr_p - 4 : 0;
  // About 0.155 ms for each temperature sample more or less than in table 9.
  const double more = (1 << osr_t) - (1 << paired_t);
  return 1.0 / kContinuousHz[osr_p] + 155e-6 * more;
}

double ChipModel::period_s() const { return 1.0 / kOdrHz[registers_[0x37] >> 2 & 31U]; }

void ChipModel::start_measuring() {
  begun_ns_ = now_ns();
  ends_ns_ = begun_ns_ + duration_ns(busy_s());
}

void ChipModel::happen() {
  const std::int64_t middle_ns = (begun_ns_ + ends_ns_) / 2;
  if (!stops) {
    double pa = air_pa(middle_ns);
    const unsigned filter = registers_[0x31] >> 3 & 7U;
    const bool shows_filtered = (registers_[0x30] & 0x20) != 0;
    if (!has_filtered_) filtered_ = pa;
    has_filtered_ = true;
    filtered_ += (pa - filtered_) / (1 << filter);
    if (shows_filtered) pa = filtered_;
    if (!frozen) newest_pressure_ = static_cast<std::uint32_t>(std::lround(pa * 64.0));
    store(0x20, newest_pressure_);
    store(0x1D, static_cast<std::uint32_t>(std::lround(temperature_c * 65'536.0)));
    if ((registers_[0x15] & 0x01) != 0) registers_[0x27] |= 0x01;
  }
  begun_ns_ += duration_ns(period_s());
  ends_ns_ = begun_ns_ + duration_ns(busy_s());
}

void ChipModel::store(unsigned address, std::uint32_t value) {
  for (unsigned i = 0; i < 3; ++i) registers_[address + i] = static_cast<std::uint8_t>(value >> (8 * i));
  if (address == 0x20) pressures.insert(value & 0xFFFFFFU);
}

void ChipModel::begin_read(std::uint8_t first) {
  pointer_ = first;
  for (unsigned i = 0; i < 6; ++i) shadow_[i] = registers_[0x1D + i];
}

std::uint8_t ChipModel::next_byte() {
  const std::uint8_t address = pointer_++;
  if (address >= 0x1D && address <= 0x22) return shadow_[address - 0x1DU];
  const bool loaded = now_ns() - start_ns_ >= memory_ready_ns;
  switch (address) {
    case 0x01:
      return id_;
    case 0x27: {
      const std::uint8_t status = registers_[address];
      registers_[address] = 0;
      return status;
    }
    case 0x28:
      return static_cast<std::uint8_t>((loaded ? 0x02 : 0) | (memory_damaged ? 0x04 : 0));
    case 0x38:
      return static_cast<std::uint8_t>((busy_s() < period_s() ? 0x80 : 0) | (registers_[0x36] & 0x3F));
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
    case 0x30:
    case 0x31:
      if (standby()) registers_[address] = value;
      break;
    case 0x37:
      registers_[address] = value;
      ends_ns_ = kNever;
      if ((value & 0x03) == 0x01) start_measuring();
      break;
    case 0x15:
    case 0x36:
      registers_[address] = value;
      break;
    default:
      break;
  }
}

}  // namespace isobar::bmp581
