// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: the barometers on a bus that the fuzzer controls. The first byte selects the sensor; then a
// byte per access selects an error, the fuzzer's bytes, or a sound chip's answer, which passes the checks.
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

#include "drivers/bmp390/sensor.hpp"
#include "drivers/bmp581/sensor.hpp"
#include "drivers/icp20100/sensor.hpp"
#include "drivers/ms5611/sensor.hpp"
#include "tests/drivers/bmp390/known_sensor.hpp"
#include "tests/drivers/ms5611/known_sensor.hpp"

namespace {

using namespace isobar;

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}
  [[nodiscard]] bool empty() const { return at_ >= bytes_.size(); }
  std::uint8_t next() { return empty() ? std::uint8_t{0} : bytes_[at_++]; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Answers of a sound chip: what was written, and these.
using Sound = std::uint8_t (*)(std::uint8_t address, std::uint8_t index, std::uint8_t written);

std::uint8_t sound_bmp581(std::uint8_t address, std::uint8_t, std::uint8_t written) {
  switch (address) {
    case bmp581::kChipId:
      return bmp581::kBmp581Id;
    case bmp581::kStatus:
      return bmp581::kNvmReady;
    case bmp581::kOsrEffective:
      return bmp581::kRateValid;
    case bmp581::kIntStatus:
      return bmp581::kDataReady;
    default:
      return written;
  }
}

std::uint8_t sound_bmp390(std::uint8_t address, std::uint8_t, std::uint8_t written) {
  const unsigned coefficient = address - unsigned{bmp390::kCoefficients};
  if (coefficient < bmp390::kCoefficientBytes) return bmp390::kKnownBytes[coefficient];
  switch (address) {
    case bmp390::kChipId:
      return bmp390::kBmp390Id;
    case bmp390::kStatus:
      return 0x70;
    case bmp390::kCoefficientCrc:
      return bmp390::coefficient_crc(bmp390::kKnownBytes);
    default:
      return written;
  }
}

std::uint8_t sound_icp20100(std::uint8_t address, std::uint8_t, std::uint8_t written) {
  switch (address) {
    case icp20100::kDeviceId:
      return icp20100::kIcp20100Id;
    case icp20100::kDeviceStatus:
      return icp20100::kModeAccessible;
    case icp20100::kFifoFill:
      return 14;
    default:
      return written;
  }
}

std::uint8_t sound_ms5611(std::uint8_t command, std::uint8_t index, std::uint8_t) {
  static const ms5611::Prom prom = ms5611::sealed(ms5611::kKnownProm);
  const unsigned word = (command - unsigned{ms5611::kReadProm}) / 2;
  if (command >= ms5611::kReadProm && word < ms5611::kPromWords) {
    return static_cast<std::uint8_t>(index == 0 ? prom[word] >> 8U : prom[word] & 0xFFU);
  }
  return 0x85;
}

class FuzzedBus final : public RegisterBus {
 public:
  FuzzedBus(Input& input, Sound sound) : input_(&input), sound_(sound) {}
  int open() noexcept override { return (input_->next() & 0xF0) == 0xF0 ? ENOENT : 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    const std::uint8_t choice = input_->next();
    if ((choice & 0xF0) == 0xF0) return EREMOTEIO;
    std::uint8_t index = 0;
    for (std::uint8_t& byte : bytes) {
      const auto address = static_cast<std::uint8_t>(first + index);
      // A command's bytes belong to the command; registers follow one another.
      const std::uint8_t asked = sound_ == sound_ms5611 ? first : address;
      byte = (choice & 1U) != 0 ? input_->next() : sound_(asked, index, written_[address]);
      ++index;
    }
    return 0;
  }
  int write(std::uint8_t address, std::uint8_t value) noexcept override {
    written_[address] = value;
    return (input_->next() & 0xF0) == 0xF0 ? EREMOTEIO : 0;
  }
  int command(std::uint8_t) noexcept override { return (input_->next() & 0xF0) == 0xF0 ? EREMOTEIO : 0; }

 private:
  Input* input_;
  Sound sound_;
  std::array<std::uint8_t, 256> written_{};
};

std::unique_ptr<Device<PressureSample>> make_sensor(unsigned choice, Input& input) {
  const auto bus = [&input](Sound sound) { return std::make_unique<FuzzedBus>(input, sound); };
  constexpr std::int64_t kStuckNs = 1'500'000'000;
  switch (choice % 4) {
    case 0:
      return std::make_unique<bmp581::Sensor>(bmp581::Settings{}, bus(sound_bmp581), kStuckNs);
    case 1:
      return std::make_unique<bmp390::Sensor>(bmp390::Settings{}, bus(sound_bmp390), kStuckNs);
    case 2:
      return std::make_unique<icp20100::Sensor>(icp20100::Settings{}, bus(sound_icp20100), kStuckNs);
    default:
      return std::make_unique<ms5611::Sensor>(ms5611::Settings{}, bus(sound_ms5611), kStuckNs);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const std::unique_ptr<Device<PressureSample>> sensor = make_sensor(input.next(), input);
  std::int64_t now_ns = 0;
  for (int steps = 0; steps < 5'000 && !input.empty(); ++steps) {
    const Device<PressureSample>::Step step = sensor->step(now_ns);
    // The next step lies in the future, at most the longest back-off away.
    if (step.next_ns <= now_ns || step.next_ns - now_ns > 6'000'000'000) std::abort();
    if (step.has_sample) {
      const PressureSample& sample = step.sample;
      if (!(sample.pressure_pa >= 30e3 && sample.pressure_pa <= 120e3)) std::abort();
      if (!(sample.temperature_c >= -40.0 && sample.temperature_c <= 85.0)) std::abort();
    }
    now_ns = step.next_ns;
  }
  return 0;
}
