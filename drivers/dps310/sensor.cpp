// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dps310/sensor.hpp"

#include <algorithm>
#include <cerrno>

namespace isobar::dps310 {

namespace {

/// Poll interval and timeout of the ready bits after a reset. The data sheet allows 12 ms for the sensor and
/// 40 ms for the coefficients.
constexpr std::int64_t kReadyPollNs = 10'000'000;
constexpr std::int64_t kReadyTimeoutNs = 100'000'000;
/// Tolerance of the data sheet's typical times: the chip's oscillator may be slower.
constexpr std::int64_t kSlackNs = 20'000'000;
/// Bounds of the poll interval, which is a quarter of the measurement period.
constexpr std::int64_t kFastestPollNs = 4'000'000;
constexpr std::int64_t kSlowestPollNs = 20'000'000;
constexpr std::uint8_t kResultsReady = kPressureReady | kTemperatureReady;
/// Largest number of reads of one result until two agree.
constexpr int kMaxReads = 4;

constexpr std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

}  // namespace

Sensor::Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns)
    : settings_(settings),
      bus_(std::move(bus)),
      place_("DPS310 on " + settings.bus + " at " + settings.address),
      poll_ns_(
          std::clamp(std::int64_t{250'000'000} / settings.pressure_rate_hz, kFastestPollNs, kSlowestPollNs)),
      pressure_time_ns_(to_ns(measurement_time_s(settings.pressure_oversampling))),
      temperature_time_ns_(to_ns(measurement_time_s(settings.temperature_oversampling))),
      temperature_silence_ns_(device_silence_ns(settings.temperature_rate_hz)),
      faults_(device_silence_ns(settings.pressure_rate_hz)),
      stuck_(stuck_time_ns) {}

Device<PressureSample>::Step Sensor::step(std::int64_t now_ns) noexcept {
  Step step;
  switch (phase_) {
    case Phase::kBegin:
      step.next_ns = begin(now_ns);
      break;
    case Phase::kWaitReady:
      step.next_ns = wait_ready(now_ns);
      break;
    case Phase::kFirstTemperature:
      step.next_ns = first_temperature(now_ns);
      break;
    case Phase::kMeasuring:
      measure(now_ns, step);
      break;
  }
  return step;
}

std::int64_t Sensor::begin(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  if (const int error = bus_->open(); error != 0) {
    ++faults_.counters().io_errors;
    const char* what = error == EBUSY     ? "a kernel driver holds the device"
                       : error == ENOTSUP ? "the bus has no SMBus byte reads and writes"
                                          : "the bus cannot be opened";
    return faults_.fail(DeviceState::kNoAnswer, what, now_ns, error);
  }
  std::uint8_t id = 0;
  if (const int error = bus_->read(kProductId, {&id, 1}); error != 0) return no_answer(error, now_ns);
  if (id != kDps310Id) {
    return fail(DeviceState::kWrongDevice, "the product id is not 0x10: another device", now_ns);
  }
  if (const int error = bus_->write(kReset, kSoftReset); error != 0) return no_answer(error, now_ns);
  phase_ = Phase::kWaitReady;
  deadline_ns_ = now_ns + kReadyTimeoutNs;
  return now_ns + kReadyPollNs;
}

std::int64_t Sensor::wait_ready(std::int64_t now_ns) noexcept {
  constexpr std::uint8_t kBoth = kCoefficientsReady | kSensorReady;
  const Ready ready = read_ready();
  if (ready.error == 0 && (ready.bits & kBoth) == kBoth) return set_up(now_ns);
  if (now_ns < deadline_ns_) return now_ns + kReadyPollNs;  // a resetting chip does not answer
  if (ready.error != 0) return no_answer(ready.error, now_ns);
  return fail(DeviceState::kWrongDevice, "sensor or coefficients not ready 0.1 s after a reset", now_ns);
}

std::int64_t Sensor::set_up(std::int64_t now_ns) noexcept {
  const char* rule = nullptr;
  int error = read_coefficients(rule);
  if (error == 0 && rule != nullptr) return fail(DeviceState::kWrongDevice, rule, now_ns);
  if (error == 0) error = apply_erratum();
  if (error == 0) error = write_settings();
  if (error == 0) error = bus_->write(kMeasurementConfig, kModeOneTemperature);
  if (error != 0) return no_answer(error, now_ns);
  phase_ = Phase::kFirstTemperature;
  deadline_ns_ = 0;  // set at the first poll: on a slow bus the set-up took longer than the measurement
  return now_ns + temperature_time_ns_;
}

int Sensor::read_coefficients(const char*& rule) noexcept {
  CoefficientBytes bytes{};
  CoefficientBytes again{};
  if (const int error = bus_->read(kCoefficients, bytes); error != 0) return error;
  if (const int error = bus_->read(kCoefficients, again); error != 0) return error;
  rule = implausibility(bytes);
  // Read twice: they have no checksum, and a flipped bit would shift every pressure until the next start.
  if (bytes != again) rule = "two reads of the coefficients differ";
  coefficients_ = decode_coefficients(bytes);
  if (const int error = bus_->read(kCoefficientSource, {&thermometer_, 1}); error != 0) return error;
  thermometer_ &= kExternalThermometer;
  return 0;
}

/// Temperature erratum: some chips read about 60 degrees C in a room of 20 until undocumented registers are
/// written. The sequence is the manufacturer's and ends with a temperature measurement (Infineon's public
/// driver, "correctTemp"; Linux, commit cc8baffe1761, "Temperature measurement errata"). Other chips are not
/// affected.
int Sensor::apply_erratum() noexcept {
  constexpr std::array<std::array<std::uint8_t, 2>, 5> kSequence{
      {{0x0E, 0xA5}, {0x0F, 0x96}, {0x62, 0x02}, {0x0E, 0x00}, {0x0F, 0x00}}};
  for (const auto& [address, value] : kSequence) {
    if (const int error = bus_->write(address, value); error != 0) return error;
  }
  return 0;
}

int Sensor::write_settings() noexcept {
  const auto rate_and_oversampling = [](int rate_hz, int oversampling) {
    return static_cast<std::uint8_t>(index_of(rate_hz) << 4U | index_of(oversampling));
  };
  constexpr int kShiftAbove = 8;
  const std::array<std::array<std::uint8_t, 2>, 3> settings{{
      {kPressureConfig, rate_and_oversampling(settings_.pressure_rate_hz, settings_.pressure_oversampling)},
      {kTemperatureConfig,
       static_cast<std::uint8_t>(thermometer_ | rate_and_oversampling(settings_.temperature_rate_hz,
                                                                      settings_.temperature_oversampling))},
      {kConfig, static_cast<std::uint8_t>(
                    (settings_.pressure_oversampling > kShiftAbove ? kShiftPressure : 0U) |
                    (settings_.temperature_oversampling > kShiftAbove ? kShiftTemperature : 0U))},
  }};
  for (const auto& [address, value] : settings) {
    std::uint8_t held = 0;
    if (const int error = bus_->write(address, value); error != 0) return error;
    if (const int error = bus_->read(address, {&held, 1}); error != 0) return error;
    if (held != value) return EIO;  // results would have the wrong scale
  }
  return 0;
}

std::int64_t Sensor::first_temperature(std::int64_t now_ns) noexcept {
  if (deadline_ns_ == 0) deadline_ns_ = now_ns + temperature_time_ns_ + kSlackNs;
  const Ready ready = read_ready();
  if (ready.error != 0) return no_answer(ready.error, now_ns);
  if ((ready.bits & kTemperatureReady) == 0) {
    if (now_ns < deadline_ns_) return now_ns + kFastestPollNs;
    return fail(DeviceState::kSilent, "no first temperature", now_ns);
  }
  raw_ = {};
  int error = read_raw(kTemperatureReady);
  if (error == 0) error = bus_->write(kMeasurementConfig, kModeBackground);
  if (error != 0) return no_answer(error, now_ns);
  phase_ = Phase::kMeasuring;
  newest_temperature_ns_ = now_ns;
  faults_.expects_results(now_ns + pressure_time_ns_);
  return now_ns + poll_ns_;
}

void Sensor::measure(std::int64_t now_ns, Step& step) noexcept {
  step.next_ns = now_ns + poll_ns_;
  const Ready first = read_ready();
  const std::uint8_t ready = first.bits;
  int error = first.error;
  if (error == 0 && (ready & kModeMask) != kModeBackground) {
    ++faults_.counters().resets;
    step.next_ns = fail(DeviceState::kSilent, "lost its settings (power failure?)", now_ns);
    return;
  }
  if (error == 0 && (ready & kResultsReady) != 0) error = read_results(ready);
  if (error != 0) {
    ++faults_.counters().io_errors;
    faults_.problem(DeviceState::kNoAnswer, "no answer", error);
  } else {
    if ((ready & kTemperatureReady) != 0) newest_temperature_ns_ = now_ns;
    if ((ready & kPressureReady) != 0) take_result(now_ns, step);
  }
  if (phase_ == Phase::kMeasuring && faults_.overdue(now_ns)) {
    phase_ = Phase::kBegin;
    step.next_ns = faults_.give_up(now_ns);
  }
}

void Sensor::take_result(std::int64_t now_ns, Step& step) noexcept {
  if (stuck_.add(raw_.pressure, now_ns)) {
    if (status().state != DeviceState::kStuck) ++faults_.counters().stuck;
    step.next_ns = fail(DeviceState::kStuck, "the result no longer changes", now_ns);
    return;
  }
  const Compensated value = compensate(coefficients_, raw_, scale_factor(settings_.pressure_oversampling),
                                       scale_factor(settings_.temperature_oversampling));
  if (const char* rule = implausibility(raw_, value); rule != nullptr) {
    ++faults_.counters().implausible;
    faults_.problem(DeviceState::kImplausible, rule);
    return;
  }
  if (now_ns - newest_temperature_ns_ > temperature_silence_ns_) {
    faults_.problem(DeviceState::kSilent,
                    "no new temperature");  // the compensation of every pressure needs one
    return;
  }
  faults_.good(now_ns);
  const double noise_pa = pressure_noise_pa(settings_.pressure_oversampling);
  step.has_sample = true;
  step.sample.stamp_ns = now_ns - (poll_ns_ + pressure_time_ns_) / 2;
  step.sample.pressure_pa = value.pressure_pa;
  step.sample.temperature_c = value.temperature_c;
  step.sample.variance_pa2 = noise_pa * noise_pa;
}

/// Reads the ready results until two reads agree: the chip may replace a result during a read, which then
/// mixes two results and may clear the ready bit of the new one. A result that is not ready is not read: the
/// read could clear the ready bit of one that arrives meanwhile.
int Sensor::read_results(std::uint8_t ready) noexcept {
  const RawResult kept = raw_;
  int error = read_raw(ready);
  for (int reads = 1; error == 0; ++reads) {
    const RawResult before = raw_;
    error = read_raw(ready);
    if (error == 0 && raw_ == before) return 0;
    if (error == 0) ++faults_.counters().torn;
    if (reads == kMaxReads) error = EAGAIN;  // results change faster than these settings allow
  }
  raw_ = kept;  // a torn temperature must not compensate the next pressure
  return error;
}

int Sensor::read_raw(std::uint8_t wanted) noexcept {
  std::array<std::uint8_t, kResultBytes> bytes{};
  constexpr std::size_t kHalf = kResultBytes / 2;
  const bool pressure = (wanted & kPressureReady) != 0;
  const bool temperature = (wanted & kTemperatureReady) != 0;
  const std::size_t first = pressure ? 0 : kHalf;
  const std::size_t count = pressure && temperature ? kResultBytes : kHalf;
  const auto address = static_cast<std::uint8_t>(kPressureResult + first);
  if (const int error = bus_->read(address, std::span(bytes).subspan(first, count)); error != 0) return error;
  const RawResult read = decode_result(bytes);
  if (pressure) raw_.pressure = read.pressure;
  if (temperature) raw_.temperature = read.temperature;
  return 0;
}

Sensor::Ready Sensor::read_ready() noexcept {
  Ready ready;
  ready.error = bus_->read(kMeasurementConfig, {&ready.bits, 1});
  return ready;
}

std::int64_t Sensor::no_answer(int error, std::int64_t now_ns) noexcept {
  ++faults_.counters().io_errors;
  phase_ = Phase::kBegin;
  return faults_.fail(DeviceState::kNoAnswer, "no answer", now_ns, error);
}

std::int64_t Sensor::fail(DeviceState state, const char* what, std::int64_t now_ns) noexcept {
  phase_ = Phase::kBegin;
  return faults_.fail(state, what, now_ns);
}

}  // namespace isobar::dps310
