// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dps310/sensor.hpp"

#include <array>
#include <cerrno>

#include "drivers/bus/choice.hpp"

namespace isobar::dps310 {

namespace {

/// Poll interval and timeout of the ready bits after a reset. The data sheet allows 12 ms for the sensor and
/// 40 ms for the coefficients.
constexpr std::int64_t kReadyPollNs = 10'000'000;
constexpr std::int64_t kReadyTimeoutNs = 100'000'000;
/// Tolerance of the data sheet's typical times: the chip's oscillator may be slower.
constexpr std::int64_t kSlackNs = 20'000'000;
constexpr std::int64_t kTemperaturePollNs = 4'000'000;
constexpr std::uint8_t kResultsReady = kPressureReady | kTemperatureReady;

constexpr std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

}  // namespace

Sensor::Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns,
               std::unique_ptr<EdgeLine> ready_line)
    : PolledBarometer(place_on_bus("DPS310", settings.bus, settings.address), std::move(bus),
                      device_silence_ns(settings.pressure_rate_hz), stuck_time_ns),
      settings_(settings),
      ready_line_(std::move(ready_line)),
      period_ns_(1'000'000'000 / settings.pressure_rate_hz),
      poll_ns_(poll_interval_ns(settings.pressure_rate_hz)),
      pressure_time_ns_(to_ns(measurement_time_s(settings.pressure_oversampling))),
      temperature_time_ns_(to_ns(measurement_time_s(settings.temperature_oversampling))),
      temperature_silence_ns_(device_silence_ns(settings.temperature_rate_hz)) {}

PolledBarometer::Outcome Sensor::start(std::int64_t now_ns) noexcept {
  std::uint8_t id = 0;
  if (const int error = bus().read(kProductId, {&id, 1}); error != 0) return no_answer(error);
  if (id != kDps310Id) {
    return fault(DeviceState::kWrongDevice, "the product id is not 0x10: another device");
  }
  if (ready_line_) {
    if (const int error = ready_line_->open(); error != 0) {
      return fault(DeviceState::kNoAnswer, "the data-ready line cannot be requested", error);
    }
  }
  if (const int error = bus().write(kReset, kSoftReset); error != 0) return no_answer(error);
  piece_ = Piece::kWaitReady;
  deadline_ns_ = now_ns + kReadyTimeoutNs;
  return wait(kReadyPollNs);
}

PolledBarometer::Outcome Sensor::set_up(std::int64_t now_ns) noexcept {
  return piece_ == Piece::kWaitReady ? wait_ready(now_ns) : first_temperature(now_ns);
}

PolledBarometer::Outcome Sensor::wait_ready(std::int64_t now_ns) noexcept {
  constexpr std::uint8_t kBoth = kCoefficientsReady | kSensorReady;
  const Ready ready = read_ready();
  if (ready.error == 0 && (ready.bits & kBoth) == kBoth) return configure();
  if (now_ns < deadline_ns_) return wait(kReadyPollNs);  // a resetting chip does not answer
  if (ready.error != 0) return no_answer(ready.error);
  return fault(DeviceState::kWrongDevice, "sensor or coefficients not ready 0.1 s after a reset");
}

PolledBarometer::Outcome Sensor::configure() noexcept {
  const char* rule = nullptr;
  int error = read_coefficients(rule);
  if (error == 0 && rule != nullptr) return fault(DeviceState::kWrongDevice, rule);
  if (error == 0) error = apply_erratum();
  if (error == 0) error = write_settings();
  if (error == 0) error = bus().write(kMeasurementConfig, kModeOneTemperature);
  if (error != 0) return no_answer(error);
  piece_ = Piece::kFirstTemperature;
  deadline_ns_ = 0;  // set at the first poll: on a slow bus the set-up took longer than the measurement
  return wait(temperature_time_ns_);
}

int Sensor::read_coefficients(const char*& rule) noexcept {
  CoefficientBytes bytes{};
  CoefficientBytes again{};
  if (const int error = bus().read(kCoefficients, bytes); error != 0) return error;
  if (const int error = bus().read(kCoefficients, again); error != 0) return error;
  rule = implausibility(bytes);
  // Read twice: they have no checksum, and a flipped bit would shift every pressure until the next start.
  if (bytes != again) rule = "two reads of the coefficients differ";
  coefficients_ = decode_coefficients(bytes);
  if (const int error = bus().read(kCoefficientSource, {&thermometer_, 1}); error != 0) return error;
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
    if (const int error = bus().write(address, value); error != 0) return error;
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
      {kConfig,
       static_cast<std::uint8_t>((settings_.pressure_oversampling > kShiftAbove ? kShiftPressure : 0U) |
                                 (settings_.temperature_oversampling > kShiftAbove ? kShiftTemperature : 0U) |
                                 (ready_line_ ? kInterruptHigh | kInterruptPressure : 0U))},
  }};
  for (const auto& [address, value] : settings) {
    // A setting that did not arrive would give results of a wrong scale.
    if (const int error = write_and_verify(address, value); error != 0) return error;
  }
  return 0;
}

PolledBarometer::Outcome Sensor::first_temperature(std::int64_t now_ns) noexcept {
  if (deadline_ns_ == 0) deadline_ns_ = now_ns + temperature_time_ns_ + kSlackNs;
  const Ready ready = read_ready();
  if (ready.error != 0) return no_answer(ready.error);
  if ((ready.bits & kTemperatureReady) == 0) {
    if (now_ns < deadline_ns_) return wait(kTemperaturePollNs);
    return fault(DeviceState::kSilent, "no first temperature");
  }
  raw_ = {};
  int error = read_results(kTemperatureReady);
  if (error == 0) error = bus().write(kMeasurementConfig, kModeBackground);
  if (error != 0) return no_answer(error);
  newest_temperature_ns_ = now_ns;
  return measuring(poll_ns_, pressure_time_ns_);
}

PolledBarometer::Outcome Sensor::read(std::int64_t now_ns, Reading& reading) noexcept {
  int error = ready_line_ ? read_line(now_ns) : 0;
  if (error != 0) return fault(DeviceState::kNoAnswer, "the data-ready line cannot be read", error);
  const Ready ready = read_ready();
  error = ready.error;
  if (error == 0 && (ready.bits & kModeMask) != kModeBackground) return lost_settings();
  if (error == 0 && (ready.bits & kResultsReady) != 0) error = read_results(ready.bits);
  const bool has_pressure = (ready.bits & kPressureReady) != 0;
  std::uint8_t interrupts = 0;
  if (error == 0 && has_pressure && ready_line_) error = bus().read(kInterruptStatus, {&interrupts, 1});
  if (error != 0) return problem(DeviceState::kNoAnswer, "no answer", poll_ns_, error);
  if ((ready.bits & kTemperatureReady) != 0) newest_temperature_ns_ = now_ns;
  if (!has_pressure) return wait(poll_ns_);
  const bool has_edge = edge_ns_ != 0;
  convert(now_ns, has_edge ? edge_ns_ : now_ns - poll_ns_ / 2, reading);
  edge_ns_ = 0;
  // The next edge comes earlier, also after a temperature; without it the result is looked for.
  return result(has_edge ? period_ns_ + temperature_time_ns_ + poll_ns_ : poll_ns_);
}

int Sensor::read_line(std::int64_t now_ns) noexcept {
  std::array<LineEdge, EdgeLine::kQueue> edges{};
  std::size_t count = 0;
  const std::int64_t line_now_ns = ready_line_->now_ns();
  if (const int error = ready_line_->read(edges, count); error != 0) return error;
  if (count == 0) return 0;
  const std::int64_t age_ns = line_now_ns - edges[count - 1].stamp_ns;
  // An edge older than a measurement belongs to a result that was read without it.
  edge_ns_ = age_ns >= 0 && age_ns < period_ns_ ? now_ns - age_ns : 0;
  return 0;
}

void Sensor::convert(std::int64_t now_ns, std::int64_t ended_ns, Reading& reading) const noexcept {
  const Compensated value = compensate(coefficients_, raw_, scale_factor(settings_.pressure_oversampling),
                                       scale_factor(settings_.temperature_oversampling));
  reading.bits = raw_.pressure;
  reading.refused = implausibility(raw_, value);
  if (reading.refused == nullptr && now_ns - newest_temperature_ns_ > temperature_silence_ns_) {
    reading.refused = "no new temperature";  // the compensation of every pressure needs one
    reading.refused_state = DeviceState::kSilent;
  }
  const double noise_pa = pressure_noise_pa(settings_.pressure_oversampling);
  reading.sample.stamp_ns = ended_ns - pressure_time_ns_ / 2;
  reading.sample.pressure_pa = value.pressure_pa;
  reading.sample.temperature_c = value.temperature_c;
  reading.sample.variance_pa2 = noise_pa * noise_pa;
}

/// Reads the ready results until two reads agree: the chip may replace a result during a read, which then
/// mixes two results and may clear the ready bit of the new one. A result that is not ready is not read: the
/// read could clear the ready bit of one that arrives meanwhile.
int Sensor::read_results(std::uint8_t ready) noexcept {
  std::array<std::uint8_t, kResultBytes> bytes{};
  constexpr std::size_t kHalf = kResultBytes / 2;
  const bool pressure = (ready & kPressureReady) != 0;
  const bool temperature = (ready & kTemperatureReady) != 0;
  const std::size_t first = pressure ? 0 : kHalf;
  const std::size_t count = pressure && temperature ? kResultBytes : kHalf;
  const auto address = static_cast<std::uint8_t>(kPressureResult + first);
  // After an error the results before are kept: a torn temperature must not compensate the next pressure.
  if (const int error = read_settled(address, std::span(bytes).subspan(first, count)); error != 0)
    return error;
  const RawResult newest = decode_result(bytes);
  if (pressure) raw_.pressure = newest.pressure;
  if (temperature) raw_.temperature = newest.temperature;
  return 0;
}

Sensor::Ready Sensor::read_ready() noexcept {
  Ready ready;
  ready.error = bus().read(kMeasurementConfig, {&ready.bits, 1});
  return ready;
}

}  // namespace isobar::dps310
