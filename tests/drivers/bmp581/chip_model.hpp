// SPDX-License-Identifier: BSD-3-Clause
// Register-level model of a BMP581 (data sheet BST-BMP581-DS004), on a simulated clock.
#pragma once

#include <array>
#include <cstdint>
#include <set>

#include "tests/drivers/barometer/model.hpp"

namespace isobar::bmp581 {

class ChipModel final : public test::BarometerModel {
 public:
  /// Starts one second after power-up.
  ChipModel() {
    power_up();
    run_until(now_ns() + 1'000'000'000);
  }

  std::int64_t memory_ready_ns = 1'800'000;  ///< after a reset; data sheet: 2 ms
  bool memory_damaged = false;               ///< STATUS.status_nvm_err
  std::uint64_t soft_resets = 0;
  std::set<std::uint32_t> pressures;  ///< every raw pressure that was ever measured
  [[nodiscard]] std::uint8_t held(std::uint8_t address) const { return registers_[address]; }

  void power_up() override;
  void become_another() override { id_ = 0x60; }

 private:
  [[nodiscard]] std::int64_t next_event_ns() const override { return ends_ns_; }
  void happen() override;
  [[nodiscard]] bool answers() const override { return now_ns() - start_ns_ >= 1'000'000; }
  void begin_read(std::uint8_t first) override;
  std::uint8_t next_byte() override;
  void take(std::uint8_t address, std::uint8_t value) override;

  [[nodiscard]] bool standby() const { return (registers_[0x37] & 0x83) == 0x80; }
  [[nodiscard]] double busy_s() const;
  [[nodiscard]] double period_s() const;
  void start_measuring();
  void store(unsigned address, std::uint32_t value);

  std::array<std::uint8_t, 256> registers_{};
  std::array<std::uint8_t, 6> shadow_{};  ///< data registers at the begin of the burst
  std::uint8_t id_ = 0x50;
  std::uint8_t pointer_ = 0;
  std::int64_t start_ns_ = 0;
  std::int64_t begun_ns_ = 0;  ///< the measurement in progress
  std::int64_t ends_ns_ = kNever;
  std::uint32_t newest_pressure_ = 0;
  double filtered_ = 0.0;
  bool has_filtered_ = false;
};

}  // namespace isobar::bmp581
