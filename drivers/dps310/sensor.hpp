// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/bus/register_bus.hpp"
#include "drivers/device/fault_watch.hpp"
#include "drivers/dps310/settings.hpp"

namespace isobar::dps310 {

/// DPS310 driver: a polled state machine without blocking waits, which restarts after every fault:
///
///   reset ──▶ ready? ──▶ coefficients, erratum, settings ──▶ one temperature ──▶ background measurement
///     ▲ after a back-off: no answer, wrong device, lost settings, silent, stuck, implausible
///
/// The ready bits are polled four times a measurement. A sample's stamp is the middle of the chip's averaging
/// time, exact to half a poll.
class Sensor final : public Device<PressureSample> {
 public:
  /// @param settings validated: busy_time_s() below 1
  /// @param stuck_time_ns see StuckWatch
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns);

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] const DeviceStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

 private:
  enum class Phase : std::uint8_t { kBegin, kWaitReady, kFirstTemperature, kMeasuring };
  /// Result of reading the ready bits.
  struct Ready {
    int error = 0;
    std::uint8_t bits = 0;
  };

  std::int64_t begin(std::int64_t now_ns) noexcept;
  std::int64_t wait_ready(std::int64_t now_ns) noexcept;
  std::int64_t set_up(std::int64_t now_ns) noexcept;
  std::int64_t first_temperature(std::int64_t now_ns) noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  void take_result(std::int64_t now_ns, Step& step) noexcept;

  int read_coefficients(const char*& rule) noexcept;
  int apply_erratum() noexcept;
  int write_settings() noexcept;
  Ready read_ready() noexcept;
  int read_results(std::uint8_t ready) noexcept;
  int read_raw(std::uint8_t wanted) noexcept;
  std::int64_t no_answer(int error, std::int64_t now_ns) noexcept;
  std::int64_t fail(DeviceState state, const char* what, std::int64_t now_ns) noexcept;

  Settings settings_;
  std::unique_ptr<RegisterBus> bus_;
  std::string place_;
  std::int64_t poll_ns_;
  std::int64_t pressure_time_ns_;
  std::int64_t temperature_time_ns_;
  std::int64_t temperature_silence_ns_;
  FaultWatch faults_;
  StuckWatch stuck_;
  Phase phase_ = Phase::kBegin;
  std::int64_t deadline_ns_ = 0;
  std::int64_t newest_temperature_ns_ = 0;
  Coefficients coefficients_;
  RawResult raw_;                 ///< newest pressure and newest temperature
  std::uint8_t thermometer_ = 0;  ///< thermometer of the coefficients: kExternalThermometer, or 0: the chip's
};

}  // namespace isobar::dps310
