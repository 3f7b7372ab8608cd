// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/barometer/polled_barometer.hpp"
#include "drivers/bmp390/settings.hpp"

namespace isobar::bmp390 {

/// BMP390 driver:
///
///   reset ──▶ ready? ──▶ coefficients, settings ──▶ normal mode
///
/// The status is polled four times a measurement. A sample's stamp is the middle of pressure and temperature
/// measurement, exact to half a poll. variance_pa2 is that without the IIR filter: a filter makes
/// neighbouring samples alike and adds no information.
class Sensor final : public PolledBarometer {
 public:
  /// @param settings validated: busy_time_s() below 1
  /// @param stuck_time_ns see StuckWatch
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns);

 private:
  Outcome start(std::int64_t now_ns) noexcept override;
  Outcome set_up(std::int64_t now_ns) noexcept override;
  Outcome read(std::int64_t now_ns, Reading& reading) noexcept override;

  Outcome configure() noexcept;
  int read_coefficients(const char*& rule) noexcept;
  int write_settings() noexcept;

  Settings settings_;
  std::int64_t poll_ns_;
  std::int64_t measurement_ns_;
  std::int64_t deadline_ns_ = 0;
  Coefficients coefficients_;
};

}  // namespace isobar::bmp390
