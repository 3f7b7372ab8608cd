// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/barometer.hpp"

#include <cerrno>
#include <limits>

#include "core/plausibility.hpp"

namespace isobar::iio {

namespace {

constexpr double kVoltsPerUnit = 1e-3;    // unit of a voltage channel: millivolt
constexpr double kPascalsPerUnit = 1e3;   // unit of a pressure channel: kilopascal
constexpr double kDegreesPerUnit = 1e-3;  // unit of a temperature channel: millidegree Celsius

}  // namespace

Barometer::Barometer(const Settings& settings, std::int64_t stuck_time_ns)
    : Barometer("barometer " + settings.folder, settings, "in_pressure", std::nullopt, stuck_time_ns) {}

Barometer::Barometer(const SetraSettings& settings, std::int64_t stuck_time_ns)
    : Barometer("Setra 278 on " + settings.device.folder + " " + settings.channel, settings.device,
                settings.channel, settings.span, stuck_time_ns) {}

Barometer::Barometer(std::string place, const Settings& settings, const std::string& channel,
                     std::optional<setra278::Span> span, std::int64_t stuck_time_ns)
    : place_(std::move(place)),
      period_ns_(1'000'000'000 / settings.rate_hz),
      channel_(settings.folder, channel),
      thermometer_(settings.folder, "in_temp"),
      span_(span),
      faults_(device_silence_ns(settings.rate_hz)),
      stuck_(stuck_time_ns) {}

Device<PressureSample>::Step Barometer::step(std::int64_t now_ns) noexcept {
  Step step;
  if (open_) {
    measure(now_ns, step);
  } else {
    step.next_ns = begin(now_ns);
  }
  return step;
}

std::int64_t Barometer::begin(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  if (const int error = channel_.open(); error != 0) {
    ++faults_.counters().io_errors;
    const char* what = error == ENOENT ? "no such device or channel" : "no answer";
    return faults_.fail(DeviceState::kNoAnswer, what, now_ns, error);
  }
  // A converter's in_temp is its own temperature, not the transducer's.
  has_thermometer_ = !span_ && thermometer_.open() == 0;
  open_ = true;
  return now_ns + period_ns_;
}

void Barometer::measure(std::int64_t now_ns, Step& step) noexcept {
  step.next_ns = now_ns + period_ns_;
  const Channel::Value reading = channel_.read();
  double pressure_pa = 0.0;
  if (reading.error != 0) {
    ++faults_.counters().io_errors;
    const char* what = reading.error == EBADMSG ? "the file does not hold a number" : "no answer";
    faults_.problem(DeviceState::kNoAnswer, what, reading.error);
  } else if (const char* fault = convert(reading.value, pressure_pa); fault != nullptr) {
    ++faults_.counters().implausible;
    faults_.problem(DeviceState::kImplausible, fault);
  } else if (stuck_.add(reading.bits, now_ns)) {
    if (status().state != DeviceState::kStuck) ++faults_.counters().stuck;
    open_ = false;
    step.next_ns = faults_.fail(DeviceState::kStuck, "the value no longer changes", now_ns);
    return;
  } else {
    faults_.good(now_ns);
    step.has_sample = true;
    step.sample.stamp_ns = now_ns;
    step.sample.timing.received_ns = now_ns;
    step.sample.pressure_pa = pressure_pa;
    step.sample.temperature_c = read_temperature();
  }
  if (faults_.overdue(now_ns)) {
    open_ = false;
    step.next_ns = faults_.give_up(now_ns);
  }
}

const char* Barometer::convert(double value, double& pressure_pa) const noexcept {
  if (span_) {
    const setra278::Reading reading = setra278::pressure_of(*span_, value * kVoltsPerUnit);
    pressure_pa = reading.pressure_pa;
    return reading.fault;
  }
  pressure_pa = value * kPascalsPerUnit;
  PressureSample sample;
  sample.pressure_pa = pressure_pa;
  return implausibility(sample);
}

/// Temperature [degrees C]; NaN when the thermometer fails, since the pressure stays valid.
double Barometer::read_temperature() noexcept {
  if (has_thermometer_) {
    const Channel::Value reading = thermometer_.read();
    const double temperature_c = reading.value * kDegreesPerUnit;
    if (reading.error == 0 && kPlausibleTemperatureC.holds(temperature_c)) return temperature_c;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace isobar::iio
