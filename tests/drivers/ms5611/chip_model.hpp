// SPDX-License-Identifier: BSD-3-Clause
// Command-level model of an MS5611-01BA03 (TE data sheet), on a simulated clock.
#pragma once

#include <array>
#include <cstdint>

#include "tests/drivers/barometer/model.hpp"
#include "tests/drivers/ms5611/known_sensor.hpp"

namespace isobar::ms5611 {

class ChipModel final : public test::BarometerModel {
 public:
  /// Starts one second after power-up.
  ChipModel() {
    power_up();
    run_until(now_ns() + 1'000'000'000);
  }

  Prom prom = sealed(kKnownProm);
  std::uint64_t soft_resets = 0;
  std::uint64_t spoiled = 0;  ///< conversions that a read or a command came into

  void power_up() override;
  void become_another() override { prom[3] ^= 0x0100U; }

 private:
  [[nodiscard]] std::int64_t next_event_ns() const override { return ends_ns_; }
  void happen() override;
  [[nodiscard]] bool answers() const override { return now_ns() - reset_ns_ >= 2'700'000; }
  void begin_read(std::uint8_t first) override;
  std::uint8_t next_byte() override;
  void take(std::uint8_t /*address*/, std::uint8_t /*value*/) override {}
  void obey(std::uint8_t code) override;

  [[nodiscard]] double raw_temperature() const;
  [[nodiscard]] double raw_pressure(double wanted_pa) const;
  void spoil();

  std::int64_t reset_ns_ = 0;
  bool loaded_ = false;  ///< the coefficients; by a reset, not by power-up
  std::int64_t begun_ns_ = 0;
  std::int64_t ends_ns_ = kNever;
  bool converting_pressure_ = false;
  std::uint32_t frozen_pressure_ = 0;
  std::uint32_t converter_ = 0;
  std::uint32_t answer_ = 0;  ///< bytes to come, uppermost first
};

}  // namespace isobar::ms5611
