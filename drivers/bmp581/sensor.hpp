// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/barometer/polled_barometer.hpp"
#include "drivers/bmp581/settings.hpp"

namespace isobar::bmp581 {

/// BMP581 driver:
///
///   reset ──▶ memory loaded? ──▶ standby ──▶ settings, rate valid? ──▶ normal mode
///
/// The interrupt status is polled four times a measurement. A sample's stamp is the middle of temperature and
/// pressure measurement, exact to half a poll. variance_pa2 is that without the IIR filter: a filter makes
/// neighbouring samples alike and adds no information.
class Sensor final : public PolledBarometer {
 public:
  /// @param settings validated: busy_time_s() below 1
  /// @param stuck_time_ns see StuckWatch
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns);

 private:
  enum class Piece : std::uint8_t { kWaitReady, kConfigure };

  Outcome start(std::int64_t now_ns) noexcept override;
  Outcome set_up(std::int64_t now_ns) noexcept override;
  Outcome read(std::int64_t now_ns, Reading& reading) noexcept override;

  Outcome wait_ready(std::int64_t now_ns) noexcept;
  Outcome configure() noexcept;
  [[nodiscard]] std::uint8_t odr_config(std::uint8_t mode) const noexcept;

  Settings settings_;
  std::int64_t poll_ns_;
  std::int64_t measurement_ns_;
  Piece piece_ = Piece::kWaitReady;
  std::int64_t deadline_ns_ = 0;
};

}  // namespace isobar::bmp581
