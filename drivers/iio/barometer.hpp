// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "drivers/device/fault_watch.hpp"
#include "drivers/iio/channel.hpp"
#include "drivers/iio/settings.hpp"

namespace isobar::iio {

/// Barometer read through the kernel's industrial I/O: a sensor with a kernel driver (in_pressure, and
/// in_temp if present), or a Setra 278 behind an analogue-to-digital converter. Its noise is unknown:
/// variance_pa2 is NaN.
class Barometer final : public Device<PressureSample> {
 public:
  /// A sensor with a pressure channel.
  /// @param stuck_time_ns see StuckWatch
  Barometer(const Settings& settings, std::int64_t stuck_time_ns);
  /// A Setra 278.
  /// @param settings span validated (setra278::broken_rule)
  Barometer(const SetraSettings& settings, std::int64_t stuck_time_ns);

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] const DeviceStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

 private:
  Barometer(std::string place, const Settings& settings, const std::string& channel,
            std::optional<setra278::Span> span, std::int64_t stuck_time_ns);

  std::int64_t begin(std::int64_t now_ns) noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  /// Converts a reading to pressure_pa; the fault, or nullptr when there is none.
  const char* convert(double value, double& pressure_pa) const noexcept;
  [[nodiscard]] double read_temperature() noexcept;

  std::string place_;
  std::int64_t period_ns_;
  Channel channel_;
  Channel thermometer_;
  std::optional<setra278::Span> span_;  ///< volts to pressure; absent: the channel is a pressure
  FaultWatch faults_;
  StuckWatch stuck_;
  bool open_ = false;
  bool has_thermometer_ = false;
};

}  // namespace isobar::iio
