// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include "drivers/barometer/polled_barometer.hpp"
#include "drivers/ms5611/settings.hpp"

namespace isobar::ms5611 {

/// MS5611 driver:
///
///   reset ──▶ coefficients ──▶ (coefficient unchanged? ──▶ temperature ──▶ pressure ──▶ pause) …
///
/// The chip measures on command, so a sample's stamp is the middle of its conversion. It shows no state:
/// before every measurement one word of the coefficients is read again, which a chip without a reset since
/// its power-up answers differently.
class Sensor final : public PolledBarometer {
 public:
  /// @param settings validated: busy_time_s() below 1
  /// @param stuck_time_ns see StuckWatch
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns);

 private:
  enum class Piece : std::uint8_t { kPause, kTemperature, kPressure };

  Outcome start(std::int64_t now_ns) noexcept override;
  Outcome set_up(std::int64_t now_ns) noexcept override;
  Outcome read(std::int64_t now_ns, Reading& reading) noexcept override;

  Outcome begin_measurement(std::int64_t now_ns) noexcept;
  Outcome convert_pressure(std::int64_t now_ns) noexcept;
  Outcome take_pressure(std::int64_t now_ns, Reading& reading) noexcept;
  /// A failed access: the next measurement comes at its time.
  Outcome broken_off(int error, std::int64_t now_ns) noexcept;
  [[nodiscard]] std::int64_t pause_ns(std::int64_t now_ns) const noexcept;
  int read_prom(std::size_t word, std::uint16_t& value) noexcept;
  int read_converter(std::uint32_t& value) noexcept;

  Settings settings_;
  std::int64_t period_ns_;
  std::int64_t temperature_wait_ns_;
  std::int64_t pressure_wait_ns_;
  Piece piece_ = Piece::kPause;
  std::int64_t begun_ns_ = 0;       ///< the measurement
  std::int64_t converting_ns_ = 0;  ///< start of the pressure's conversion
  std::size_t checked_word_ = 0;
  Prom prom_{};
  RawResult raw_;
};

}  // namespace isobar::ms5611
