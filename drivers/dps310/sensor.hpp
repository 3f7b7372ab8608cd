// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/barometer/fault_watch.hpp"
#include "drivers/dps310/register_bus.hpp"
#include "drivers/dps310/settings.hpp"

namespace isobar::dps310 {

/// A DPS310 from power-up to samples, and back again after every fault. A state machine that is asked when
/// something can be due, so that no wait blocks:
///
///   reset ──▶ ready? ──▶ coefficients, erratum, settings ──▶ one temperature ──▶ background measurement
///     ▲ after a wait that doubles: no answer, wrong device, lost settings, silent, stuck, implausible
///
/// While it measures, the ready bits are polled four times a measurement. The stamp of a sample is the middle
/// of the time over which the chip averaged, known to half a poll.
class Sensor final : public BarometerDevice {
 public:
  /// settings: checked already (busy_time_s() below 1). stuck_time_ns: see StuckWatch.
  Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns);

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] const BarometerStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

 private:
  enum class Phase : std::uint8_t { kBegin, kWaitReady, kFirstTemperature, kMeasuring };
  /// The outcome of an access: the ready bits, or the fault.
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
  std::int64_t fail(BarometerState state, const char* what, std::int64_t now_ns) noexcept;

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
  RawResult raw_;                 ///< the newest of each
  std::uint8_t thermometer_ = 0;  ///< kExternalThermometer or 0: the one that the coefficients are made for
};

}  // namespace isobar::dps310
