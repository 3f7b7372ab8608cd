// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/dps310/chip_model.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::dps310 {

namespace {

constexpr std::int64_t kSilentAfterResetNs = 2'500'000;
constexpr std::array<std::array<std::uint8_t, 2>, 5> kErratum{
    {{0x0E, 0xA5}, {0x0F, 0x96}, {0x62, 0x02}, {0x0E, 0x00}, {0x0F, 0x00}}};

std::int64_t duration_ns(int oversampling, double slow) {
  return static_cast<std::int64_t>(measurement_time_s(oversampling) * slow * 1e9);
}

}  // namespace

void ChipModel::power_up() {
  registers_.fill(0);
  std::copy(kKnownBytes.begin(), kKnownBytes.end(), registers_.begin() + kCoefficients);
  registers_[kPressureResult] = 0x80;  // no result yet
  registers_[kTemperatureResult] = 0x80;
  start_ns_ = now_ns_;
  mode_ = kModeIdle;
  pressure_ = temperature_ = Conversion{};
  erratum_step_ = 0;
  corrected_ = false;
}

void ChipModel::run_until(std::int64_t now_ns) {
  for (;;) {
    start_due();
    std::int64_t end_ns = now_ns + 1;
    for (const Conversion* c : {&pressure_, &temperature_}) {
      if (c->end_ns != 0) end_ns = std::min(end_ns, c->end_ns);
      if (c->end_ns == 0 && c->due_ns > now_ns_) end_ns = std::min(end_ns, c->due_ns);
    }
    if (end_ns > now_ns) break;
    now_ns_ = std::max(now_ns_, end_ns);
    if (pressure_.end_ns == now_ns_) finish(true);
    if (temperature_.end_ns == now_ns_) finish(false);
  }
  now_ns_ = std::max(now_ns_, now_ns);
}

/// The chip's single converter: when free it starts the measurement that has been due longest, on a tie
/// pressure.
void ChipModel::start_due() {
  if (pressure_.end_ns != 0 || temperature_.end_ns != 0) return;
  const bool background = mode_ == kModeBackground;
  const bool pressure_due = background && pressure_.due_ns <= now_ns_;
  const bool temperature_due = (background || mode_ == kModeOneTemperature) && temperature_.due_ns <= now_ns_;
  if (pressure_due && (!temperature_due || pressure_.due_ns <= temperature_.due_ns)) {
    pressure_.end_ns = now_ns_ + duration_ns(oversampling(kPressureConfig), slow);
  } else if (temperature_due) {
    temperature_.end_ns = now_ns_ + duration_ns(oversampling(kTemperatureConfig), slow);
  }
}

void ChipModel::finish(bool pressure) {
  Conversion& conversion = pressure ? pressure_ : temperature_;
  const std::uint8_t config = pressure ? kPressureConfig : kTemperatureConfig;
  const std::int64_t middle_ns = now_ns_ - duration_ns(oversampling(config), slow) / 2;
  conversion.end_ns = 0;
  conversion.due_ns = std::max(conversion.due_ns + period_ns(config), now_ns_ - period_ns(config));
  if (stops || (!pressure && thermometer_stops)) return;
  if (pressure) {
    if (!frozen) newest_pressure_ = raw_pressure(middle_ns);
    store(kPressureResult, newest_pressure_);
    registers_[kMeasurementConfig] |= kPressureReady;
    // Data sheet, INT_STS: the line stays active until the status is read.
    if ((registers_[kConfig] & 0x90) == 0x90 && (registers_[0x0A] & 0x01) == 0) {
      registers_[0x0A] |= 0x01;
      interrupts.push_back(now_ns_);
    }
  } else {
    store(kTemperatureResult, raw_temperature());
    registers_[kMeasurementConfig] |= kTemperatureReady;
    corrected_ = corrected_ || erratum_step_ == 5;  // effective from the next temperature on
    if (mode_ == kModeOneTemperature) set_mode(kModeIdle);
  }
}

void ChipModel::store(std::uint8_t address, std::int32_t raw) {
  const auto word = static_cast<std::uint32_t>(raw);
  for (unsigned i = 0; i < 3; ++i) registers_[address + i] = static_cast<std::uint8_t>(word >> (16 - 8 * i));
  if (address == kPressureResult) pressures.insert(raw);
}

std::int32_t ChipModel::raw_temperature() {
  const Coefficients& c = kKnownCoefficients;
  double read_c = temperature_c;
  const bool uses_external = (registers_[kTemperatureConfig] & kExternalThermometer) != 0;
  if (uses_external != external_thermometer) read_c += 30.0;  // coefficients of the other thermometer
  if (hot_until_corrected && !corrected_) read_c += 40.0;
  ts_ = (temperature_c - 0.5 * c.c0) / c.c1;
  const double ts = (read_c - 0.5 * c.c0) / c.c1;
  return static_cast<std::int32_t>(std::lround(ts * scale_factor(oversampling(kTemperatureConfig))));
}

/// Inverse of the compensation, by Newton's method. Without the shift bit a result above 8 times oversampling
/// overflows.
std::int32_t ChipModel::raw_pressure(std::int64_t middle_ns) {
  const Coefficients& c = kKnownCoefficients;
  const double wanted = pressure_pa(static_cast<double>(middle_ns) * 1e-9) +
                        noise_pa * std::normal_distribution<double>()(random_);
  double ps = 0.0;
  for (int i = 0; i < 8; ++i) {
    const double p =
        c.c00 + ps * (c.c10 + ps * (c.c20 + ps * c.c30)) + ts_ * c.c01 + ts_ * ps * (c.c11 + ps * c.c21);
    const double slope = c.c10 + ps * (2.0 * c.c20 + 3.0 * ps * c.c30) + ts_ * (c.c11 + 2.0 * ps * c.c21);
    ps -= (p - wanted) / slope;
  }
  const int times = oversampling(kPressureConfig);
  const auto raw = static_cast<std::int32_t>(std::lround(ps * scale_factor(times)));
  const bool shifted = (registers_[kConfig] & kShiftPressure) != 0;
  return shifted == (times > 8) ? raw : static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) << 15) >> 8;
}

bool ChipModel::acknowledges(std::int64_t byte_count) {
  ++transactions;
  run_until(now_ns_ + (byte_count + 3) * byte_time_ns);
  if (unplugged || now_ns_ - start_ns_ < kSilentAfterResetNs) return false;
  return nak_share == 0.0 || std::uniform_real_distribution<double>()(random_) >= nak_share;
}

int ChipModel::read(std::uint8_t first, std::span<std::uint8_t> bytes) {
  if (!acknowledges(0)) return EREMOTEIO;
  for (std::uint8_t& byte : bytes) {
    run_until(now_ns_ + byte_time_ns);
    byte = value_of(first++);
  }
  return 0;
}

std::uint8_t ChipModel::value_of(std::uint8_t address) {
  const bool coefficients_ready = now_ns_ - start_ns_ >= coefficients_ready_ns;
  if (address >= kCoefficients && address < kCoefficients + kCoefficientBytes && !coefficients_ready)
    return 0;
  switch (address) {
    case kProductId:
      return id;
    case kCoefficientSource:
      return external_thermometer ? kExternalThermometer : 0;
    case 0x0A: {
      const std::uint8_t status = registers_[address];
      registers_[address] = 0;
      return status;
    }
    case kPressureResult + 2:
      registers_[kMeasurementConfig] &= static_cast<std::uint8_t>(~kPressureReady);
      return registers_[address];
    case kTemperatureResult + 2:
      registers_[kMeasurementConfig] &= static_cast<std::uint8_t>(~kTemperatureReady);
      return registers_[address];
    case kMeasurementConfig:
      return static_cast<std::uint8_t>(registers_[address] | mode_ |
                                       (coefficients_ready ? kCoefficientsReady : 0U) |
                                       (now_ns_ - start_ns_ >= sensor_ready_ns ? kSensorReady : 0U));
    default:
      return registers_[address];
  }
}

int ChipModel::write(std::uint8_t address, std::uint8_t value) {
  if (!acknowledges(1)) return EREMOTEIO;
  const auto& [expected_address, expected_value] = kErratum[static_cast<std::size_t>(erratum_step_ % 5)];
  if (address == expected_address && value == expected_value) ++erratum_step_;
  switch (address) {
    case kReset:
      if ((value & 0x0F) == 0x09) {
        ++soft_resets;
        power_up();
      }
      break;
    case kMeasurementConfig:
      set_mode(value & 0x07);
      break;
    case kPressureConfig:
    case kTemperatureConfig:
    case kConfig:
      registers_[address] = value;
      break;
    default:
      break;
  }
  return 0;
}

void ChipModel::set_mode(std::uint8_t mode) {
  mode_ = mode;
  pressure_ = temperature_ = Conversion{now_ns_, 0};
}

}  // namespace isobar::dps310
