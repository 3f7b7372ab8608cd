// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/icp20100/chip_model.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::icp20100 {

namespace {

constexpr std::array<std::uint8_t, 3> kTrimming{0x2B, 0x05, 0x63};  // OTP 0xF8, 0xF9, 0xFA
constexpr std::size_t kDepth = 16;
/// The FIR filter: 15 equal taps, so that 14 results pass until it is filled.
constexpr int kTaps = 15;

}  // namespace

void ChipModel::power_up() {
  registers_.fill(0);
  registers_[0x05] = 0xC0;  // bits beside the trimming, which must stay
  registers_[0x07] = 0x8A;
  registers_[0x06] = 0x80;
  start_ns_ = mode_set_ns_ = now_ns();
  ends_ns_ = kNever;
  results_ = 0;
  fifo_.clear();
  fifo_at_ = 0;
  needs_dummy_ = false;
}

bool ChipModel::trimmed() const {
  return version == 0xB2 ||
         (registers_[0x05] == (0xC0 | kTrimming[0]) && registers_[0x07] == (0x8A | kTrimming[1] << 4) &&
          registers_[0x06] == (0x80 | kTrimming[2]));
}

double ChipModel::rate_hz() const {
  constexpr std::array<double, 4> kRate{25, 120, 40, 2};  // data sheet table 5
  return kRate[std::min(registers_[0xC0] >> 5, 3)];
}

void ChipModel::happen() {
  ++results_;
  if (!stops) {
    const std::int64_t period_ns = duration_ns(1.0 / rate_hz());
    double sum_pa = 0.0;
    for (int tap = 0; tap < kTaps; ++tap) sum_pa += air_pa(now_ns() - tap * period_ns);
    double pa = sum_pa / kTaps;
    if (results_ < kTaps) pa *= static_cast<double>(results_) / kTaps;  // the filter is not full
    if (!trimmed()) pa *= 1.03;
    if (!frozen) newest_.pressure = static_cast<std::int32_t>(std::lround((pa - 70e3) / 40e3 * 131'072.0));
    newest_.temperature = static_cast<std::int32_t>(std::lround((temperature_c - 25.0) / 65.0 * 262'144.0));
    if (fifo_.size() == kDepth && !overrun_keeps_oldest) fifo_.pop_front();
    if (fifo_.size() < kDepth) fifo_.push_back(newest_);
  }
  ends_ns_ += duration_ns(1.0 / rate_hz());
}

std::uint8_t ChipModel::fifo_byte() {
  if (fifo_.empty()) return 0;
  const Result& first = fifo_.front();
  const auto word = static_cast<std::uint32_t>(fifo_at_ < 3 ? first.pressure : first.temperature);
  const auto byte = static_cast<std::uint8_t>((word & 0xFFFFFU) >> (8 * (fifo_at_ % 3)));
  if (++fifo_at_ == 6) fifo_at_ = 0;
  return byte;
}

/// The one-time programmable memory answers with its supply on, unlocked and enabled.
bool ChipModel::memory_open() const {
  constexpr std::array<std::uint8_t, 6> kParameters{0x10, 0x80, 0x04, 0x04, 0x21, 0x20};  // 0xAD … 0xB2
  return registers_[0xC0] == 0x04 && now_ns() - mode_set_ns_ >= 4'000'000 && registers_[0xBE] == 0x1F &&
         (registers_[0xAC] & 0x03) == 0x03 && (registers_[0xBC] & 0x80) == 0 &&
         std::equal(kParameters.begin(), kParameters.end(), registers_.begin() + 0xAD);
}

void ChipModel::begin_read(std::uint8_t first) {
  pointer_ = first;
  fifo_at_ = 0;
  // The read of the dummy register ends a burst of the FIFO: the result read is gone only then.
  if (first == 0x00 && needs_dummy_ && !fifo_.empty()) fifo_.pop_front();
  needs_dummy_ = first == 0xFA || (needs_dummy_ && first != 0x00);
}

std::uint8_t ChipModel::next_byte() {
  const std::uint8_t address = pointer_ >= 0xFA ? std::uint8_t{0xFA} : pointer_++;
  switch (address) {
    case 0x0C:
      return id_;
    case 0xB8: {
      const unsigned word = registers_[0xB5] - 0xF8U;
      return memory_open() && word < 3 && registers_[0xB6] == 0x10 ? kTrimming[word] : std::uint8_t{0xFF};
    }
    case 0xB9:
      return memory_stays_busy ? 1 : 0;
    case 0xC4:
      return static_cast<std::uint8_t>((fifo_.empty() ? 0x40 : 0) | (fifo_.size() == kDepth ? 0x20 : 0) |
                                       static_cast<int>(fifo_.size()));
    case 0xCD:
      return now_ns() - mode_set_ns_ >= mode_sync_ns ? 0x01 : 0x00;
    case 0xD3:
      return version;
    case 0xFA:
      return fifo_byte();
    default:
      return registers_[address];
  }
}

void ChipModel::take(std::uint8_t address, std::uint8_t value) {
  const bool trim = address >= 0x05 && address <= 0x07;
  if (needs_dummy_) return;  // the FIFO's burst still holds the bus inside the chip
  switch (address) {
    case 0xC0:
      if (now_ns() - mode_set_ns_ < mode_sync_ns) {
        ++mode_writes_lost;
        return;
      }
      registers_[address] = value;
      mode_set_ns_ = now_ns();
      results_ = 0;
      ends_ns_ = (value & 0x08) != 0 ? now_ns() + duration_ns(1.0 / rate_hz()) : kNever;
      break;
    case 0xC1:
      registers_[address] &= static_cast<std::uint8_t>(~value);
      break;
    case 0xC4:
      if ((value & 0x80) != 0) fifo_.clear();
      fifo_at_ = 0;
      break;
    default:
      if (trim && registers_[0xBE] != 0x1F) return;  // locked
      registers_[address] = value;
      break;
  }
}

}  // namespace isobar::icp20100
