// SPDX-License-Identifier: BSD-3-Clause
// What the models of all barometers share: a simulated clock, the air, the bus, and faults.
#pragma once

#include <array>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <random>
#include <span>

#include "drivers/bus/register_bus.hpp"

namespace isobar::test {

/// A chip on a bus. A model answers as its data sheet says and knows nothing of the driver.
class BarometerModel {
 public:
  virtual ~BarometerModel() = default;

  // Inputs, set by the test.
  std::function<double(double)> pressure_pa = [](double) { return 96'000.0; };  ///< by time [s]
  double temperature_c = 21.0;
  double noise_pa = 0.0;               ///< rms of each conversion
  std::int64_t byte_time_ns = 25'000;  ///< at 400 kHz; a transaction takes three more
  double slow = 1.0;                   ///< factor on all durations: error of the chip's oscillator

  // Faults.
  bool unplugged = false;  ///< no transaction is acknowledged
  double nak_share = 0.0;  ///< share of transactions that are not acknowledged
  std::uint64_t lost_write =
      0;                ///< number of a write, from 1, that is acknowledged and never arrives; 0: none
  bool stops = false;   ///< conversions no longer end
  bool frozen = false;  ///< conversions end with the bits of the last one
  /// During a measurement: a brown-out.
  virtual void power_up() = 0;
  /// Another device from now on, or a damaged memory.
  virtual void become_another() = 0;

  /// Runs the chip up to this time.
  void run_until(std::int64_t now_ns);
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

  // Outputs, read by the test.
  std::uint64_t transactions = 0;
  std::uint64_t writes = 0;

  // The bus.
  int read(std::uint8_t first, std::span<std::uint8_t> bytes);
  int write(std::uint8_t address, std::uint8_t value);
  int command(std::uint8_t code);

 protected:
  /// Time of the next event of the chip, or a time in the far future.
  [[nodiscard]] virtual std::int64_t next_event_ns() const = 0;
  virtual void happen() = 0;  ///< the event at next_event_ns()
  /// False while the chip does not answer.
  [[nodiscard]] virtual bool answers() const = 0;
  virtual void begin_read(std::uint8_t first) = 0;
  virtual std::uint8_t next_byte() = 0;
  virtual void take(std::uint8_t address, std::uint8_t value) = 0;
  virtual void obey(std::uint8_t /*code*/) {}

  static constexpr std::int64_t kNever = std::int64_t{1} << 62;
  [[nodiscard]] std::int64_t duration_ns(double seconds) const {
    return static_cast<std::int64_t>(seconds * slow * 1e9);
  }
  /// Pressure of the air at this time, with noise [Pa].
  [[nodiscard]] double air_pa(std::int64_t at_ns) {
    return pressure_pa(static_cast<double>(at_ns) * 1e-9) +
           noise_pa * std::normal_distribution<double>()(random_);
  }

 private:
  bool acknowledges(std::int64_t byte_count);

  std::int64_t now_ns_ = 1'000'000'000'000;
  std::mt19937 random_{3};
};

/// RegisterBus of the driver, connected to a model.
class BarometerBus final : public RegisterBus {
 public:
  explicit BarometerBus(BarometerModel& chip) : chip_(&chip) {}
  int open() noexcept override { return open_error; }
  int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override;
  int write(std::uint8_t address, std::uint8_t value) noexcept override {
    return chip_->write(address, value);
  }
  int command(std::uint8_t code) noexcept override { return chip_->command(code); }
  [[nodiscard]] bool bursts() const noexcept override { return has_bursts; }

  int open_error = 0;
  bool has_bursts = true;  ///< false: every byte is a transaction of its own

 private:
  BarometerModel* chip_;
};

}  // namespace isobar::test
