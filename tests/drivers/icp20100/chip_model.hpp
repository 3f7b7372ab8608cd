// SPDX-License-Identifier: BSD-3-Clause
// Register-level model of an ICP-20100 (data sheet DS-000416), on a simulated clock.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "tests/drivers/barometer/model.hpp"

namespace isobar::icp20100 {

class ChipModel final : public test::BarometerModel {
 public:
  /// Starts one second after power-up.
  ChipModel() {
    power_up();
    run_until(now_ns() + 1'000'000'000);
  }

  std::uint8_t version = 0xB2;          ///< 0x00: version A, which needs the boot sequence
  std::int64_t mode_sync_ns = 500'000;  ///< time after a change of mode in which it cannot be changed
  std::uint64_t mode_writes_lost = 0;   ///< written in that time
  bool overrun_keeps_oldest = false;    ///< a full FIFO drops the new result; else the oldest
  bool memory_stays_busy = false;       ///< OTP_STATUS never 0
  [[nodiscard]] std::uint8_t held(std::uint8_t address) const { return registers_[address]; }
  [[nodiscard]] bool trimmed() const;

  void power_up() override;
  void become_another() override { id_ = 0x47; }

 private:
  struct Result {
    std::int32_t pressure = 0;
    std::int32_t temperature = 0;
  };

  [[nodiscard]] std::int64_t next_event_ns() const override { return ends_ns_; }
  void happen() override;
  [[nodiscard]] bool answers() const override { return now_ns() - start_ns_ >= 3'000'000; }
  void begin_read(std::uint8_t first) override;
  std::uint8_t next_byte() override;
  void take(std::uint8_t address, std::uint8_t value) override;

  [[nodiscard]] double rate_hz() const;
  [[nodiscard]] std::uint8_t fifo_byte();
  [[nodiscard]] bool memory_open() const;

  std::array<std::uint8_t, 256> registers_{};
  std::uint8_t id_ = 0x63;
  std::uint8_t pointer_ = 0;
  std::int64_t start_ns_ = 0;
  std::int64_t mode_set_ns_ = 0;
  std::int64_t ends_ns_ = kNever;
  std::uint64_t results_ = 0;  ///< since the start of this mode
  std::deque<Result> fifo_;
  int fifo_at_ = 0;           ///< bytes read of the first result
  bool needs_dummy_ = false;  ///< the FIFO was read, and the dummy register not since
  Result newest_;
};

}  // namespace isobar::icp20100
