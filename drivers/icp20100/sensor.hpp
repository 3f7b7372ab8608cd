// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/barometer/polled_barometer.hpp"
#include "drivers/icp20100/settings.hpp"

namespace isobar::icp20100 {

/// ICP-20100 driver:
///
///   standby ──▶ version A: boot sequence ──▶ settings, continuous mode ──▶ filter settled
///
/// The level of the FIFO is polled four times a measurement; results that wait are read one a step. The chip
/// has no command for a reset: standby and an empty FIFO take its place. A sample's stamp is that of its
/// arrival less half of the filter's settling time, which is the delay of a filter with linear phase; the
/// data sheet states no delay.
class Sensor final : public PolledBarometer {
 public:
  /// @param stuck_time_ns see StuckWatch
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns);

 private:
  enum class Piece : std::uint8_t { kStandby, kLook, kBoot, kConfigure, kSettle };

  Outcome start(std::int64_t now_ns) noexcept override;
  Outcome set_up(std::int64_t now_ns) noexcept override;
  Outcome read(std::int64_t now_ns, Reading& reading) noexcept override;

  Outcome select(std::uint8_t mode, Piece next, std::int64_t wait_ns) noexcept;
  Outcome look_at_version() noexcept;
  Outcome boot() noexcept;
  Outcome configure(std::int64_t now_ns) noexcept;
  Outcome settle(std::int64_t now_ns) noexcept;
  int read_trimming(std::uint8_t address, std::uint8_t& value) noexcept;
  int change(std::uint8_t address, std::uint8_t clear, std::uint8_t set) noexcept;
  [[nodiscard]] std::uint8_t running_mode() const noexcept;

  const Mode& mode_;
  std::int64_t period_ns_;
  std::int64_t poll_ns_;
  double variance_pa2_;
  Piece piece_ = Piece::kStandby;
  std::int64_t deadline_ns_ = 0;
};

}  // namespace isobar::icp20100
