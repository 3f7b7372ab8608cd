// SPDX-License-Identifier: BSD-3-Clause
// Register-level model of a DPS310 (data sheet), on a simulated clock.
#pragma once

#include <array>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "drivers/bus/register_bus.hpp"
#include "tests/drivers/dps310/known_sensor.hpp"

namespace isobar::dps310 {

/// The chip and the air around it.
class ChipModel {
 public:
  /// Starts one second after power-up.
  ChipModel() {
    power_up();
    run_until(now_ns_ + 1'000'000'000);
  }

  // Inputs, set by the test.
  std::function<double(double)> pressure_pa = [](double) { return 96'000.0; };  ///< by time [s]
  double temperature_c = 21.0;
  double noise_pa = 0.0;                            ///< rms of each conversion
  std::int64_t byte_time_ns = 25'000;               ///< at 400 kHz; a transaction takes three more
  std::int64_t coefficients_ready_ns = 38'000'000;  ///< after a reset; data sheet: 40 ms at most
  std::int64_t sensor_ready_ns = 11'000'000;        ///< 12 ms at most
  std::uint8_t id = kDps310Id;
  bool external_thermometer = true;  ///< true: the coefficients are those of the external one
  bool hot_until_corrected = false;  ///< a chip that reads 40 K too much without the erratum sequence
  double slow = 1.0;                 ///< factor on all durations: error of the chip's oscillator

  // Faults.
  bool unplugged = false;  ///< no transaction is acknowledged
  double nak_share = 0.0;  ///< share of transactions that are not acknowledged
  bool stops = false;      ///< conversions no longer end
  bool frozen = false;     ///< conversions end with the bits of the last one
  bool thermometer_stops = false;
  void power_up();  ///< during a measurement: a brown-out

  /// Runs the chip up to this time.
  void run_until(std::int64_t now_ns);
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

  // Outputs, read by the test.
  std::uint64_t transactions = 0;
  std::uint64_t soft_resets = 0;
  std::vector<std::int64_t> interrupts;  ///< times at which the interrupt line rose, clock of the chip
  std::set<std::int32_t> pressures;      ///< every raw pressure that was ever measured
  [[nodiscard]] std::uint8_t held(std::uint8_t address) const { return registers_[address]; }

  // The bus.
  int read(std::uint8_t first, std::span<std::uint8_t> bytes);
  int write(std::uint8_t address, std::uint8_t value);

 private:
  struct Conversion {
    std::int64_t due_ns = 0;
    std::int64_t end_ns = 0;  ///< 0: not running
  };

  bool acknowledges(std::int64_t byte_count);
  std::uint8_t value_of(std::uint8_t address);
  void set_mode(std::uint8_t mode);
  void start_due();
  void finish(bool pressure);
  void store(std::uint8_t address, std::int32_t raw);
  [[nodiscard]] int oversampling(std::uint8_t config) const { return 1 << (registers_[config] & 7); }
  [[nodiscard]] std::int64_t period_ns(std::uint8_t config) const {
    return static_cast<std::int64_t>(slow * 1e9) >> (registers_[config] >> 4 & 7);
  }
  [[nodiscard]] std::int32_t raw_temperature();
  [[nodiscard]] std::int32_t raw_pressure(std::int64_t middle_ns);

  std::array<std::uint8_t, 256> registers_{};
  std::int64_t now_ns_ = 1'000'000'000'000;
  std::int64_t start_ns_ = 0;
  std::uint8_t mode_ = kModeIdle;
  Conversion pressure_;
  Conversion temperature_;
  double ts_ = 0.0;  ///< true scaled temperature at the last conversion, for raw_pressure()
  std::int32_t newest_pressure_ = 0;
  int erratum_step_ = 0;
  bool corrected_ = false;
  std::mt19937 random_{3};
};

/// RegisterBus of the driver, connected to the model.
class ModelBus final : public RegisterBus {
 public:
  explicit ModelBus(ChipModel& chip) : chip_(&chip) {}
  int open() noexcept override { return open_error; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
    return chip_->read(first, bytes);
  }
  int write(std::uint8_t address, std::uint8_t value) noexcept override {
    return chip_->write(address, value);
  }
  int open_error = 0;

 private:
  ChipModel* chip_;
};

}  // namespace isobar::dps310
