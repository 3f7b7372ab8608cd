// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: the DPS310 driver on a bus that the fuzzer controls. A byte per access selects an error, the
// fuzzer's bytes, or a sound chip's answer, which passes the checks.
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

#include "drivers/dps310/sensor.hpp"
#include "tests/drivers/dps310/known_sensor.hpp"

namespace {

using namespace isobar;
using namespace isobar::dps310;

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}
  [[nodiscard]] bool empty() const { return at_ >= bytes_.size(); }
  std::uint8_t next() { return empty() ? std::uint8_t{0} : bytes_[at_++]; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

class FuzzedBus final : public RegisterBus {
 public:
  explicit FuzzedBus(Input& input) : input_(&input) {}
  int open() noexcept override { return (input_->next() & 0xF0) == 0xF0 ? ENOENT : 0; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    const std::uint8_t choice = input_->next();
    if ((choice & 0xF0) == 0xF0) return EREMOTEIO;
    for (std::uint8_t& byte : bytes) {
      byte = (choice & 1U) != 0 ? input_->next() : sound(first);
      ++first;
    }
    return 0;
  }
  int write(std::uint8_t address, std::uint8_t value) noexcept override {
    written_[address] = value;
    return (input_->next() & 0xF0) == 0xF0 ? EREMOTEIO : 0;
  }

 private:
  [[nodiscard]] std::uint8_t sound(std::uint8_t address) const {
    if (address >= kCoefficients && address < kCoefficients + kCoefficientBytes) {
      return kKnownBytes[address - kCoefficients];
    }
    if (address == kProductId) return kDps310Id;
    if (address == kMeasurementConfig) return 0xF0 | (written_[address] & kModeBackground);
    return written_[address];
  }

  Input* input_;
  std::array<std::uint8_t, 256> written_{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  Sensor sensor({}, std::make_unique<FuzzedBus>(input), 1'500'000'000);
  std::int64_t now_ns = 0;
  for (int steps = 0; steps < 5'000 && !input.empty(); ++steps) {
    const isobar::Device<PressureSample>::Step step = sensor.step(now_ns);
    // The next step lies in the future, at most the longest back-off away.
    if (step.next_ns <= now_ns || step.next_ns - now_ns > 6'000'000'000) std::abort();
    if (step.has_sample) {
      const isobar::PressureSample& sample = step.sample;
      if (!(sample.pressure_pa >= 30e3 && sample.pressure_pa <= 120e3)) std::abort();
      if (!(sample.temperature_c >= -40.0 && sample.temperature_c <= 85.0)) std::abort();
    }
    now_ns = step.next_ns;
  }
  return 0;
}
