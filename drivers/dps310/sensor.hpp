// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/barometer/polled_barometer.hpp"
#include "drivers/dps310/settings.hpp"
#include "drivers/gpio/edge_line.hpp"

namespace isobar::dps310 {

/// DPS310 driver:
///
///   reset ──▶ ready? ──▶ coefficients, erratum, settings ──▶ one temperature ──▶ background measurement
///
/// The ready bits are polled four times a measurement; with a data-ready line at its edges instead, and as
/// before when none comes. A sample's stamp is the middle of the chip's averaging time, exact to half a poll,
/// or by the kernel's stamp of the edge.
class Sensor final : public PolledBarometer {
 public:
  /// @param settings validated: busy_time_s() below 1
  /// @param stuck_time_ns see StuckWatch
  /// @param ready_line rises at every pressure; null: none
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns,
         std::unique_ptr<EdgeLine> ready_line = nullptr);

  [[nodiscard]] int file_descriptor() const noexcept override {
    return ready_line_ ? ready_line_->file_descriptor() : -1;
  }

 private:
  enum class Piece : std::uint8_t { kWaitReady, kFirstTemperature };
  /// Result of reading the ready bits.
  struct Ready {
    int error = 0;
    std::uint8_t bits = 0;
  };

  Outcome start(std::int64_t now_ns) noexcept override;
  Outcome set_up(std::int64_t now_ns) noexcept override;
  Outcome read(std::int64_t now_ns, Reading& reading) noexcept override;

  Outcome wait_ready(std::int64_t now_ns) noexcept;
  Outcome configure() noexcept;
  Outcome first_temperature(std::int64_t now_ns) noexcept;
  /// @param ended_ns of the pressure measurement, robot clock
  void convert(std::int64_t now_ns, std::int64_t ended_ns, Reading& reading) const noexcept;
  /// Takes the edges that wait.
  int read_line(std::int64_t now_ns) noexcept;
  int read_coefficients(const char*& rule) noexcept;
  int apply_erratum() noexcept;
  int write_settings() noexcept;
  Ready read_ready() noexcept;
  int read_results(std::uint8_t ready) noexcept;

  Settings settings_;
  std::unique_ptr<EdgeLine> ready_line_;
  std::int64_t period_ns_;
  std::int64_t poll_ns_;
  std::int64_t pressure_time_ns_;
  std::int64_t temperature_time_ns_;
  std::int64_t temperature_silence_ns_;
  Piece piece_ = Piece::kWaitReady;
  std::int64_t deadline_ns_ = 0;
  std::int64_t newest_temperature_ns_ = 0;
  std::int64_t edge_ns_ =
      0;  ///< newest edge of the data-ready line since the last pressure, robot clock; 0: none
  Coefficients coefficients_;
  RawResult raw_;                 ///< newest pressure and newest temperature
  std::uint8_t thermometer_ = 0;  ///< thermometer of the coefficients: kExternalThermometer, or 0: the chip's
};

}  // namespace isobar::dps310
