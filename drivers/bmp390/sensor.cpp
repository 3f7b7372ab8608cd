// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bmp390/sensor.hpp"

#include <array>
#include <bit>

#include "drivers/bus/choice.hpp"

namespace isobar::bmp390 {

namespace {

/// The data sheet allows 2 ms for the start after a reset (table 2, t_startup).
constexpr std::int64_t kReadyPollNs = 5'000'000;
constexpr std::int64_t kReadyTimeoutNs = 50'000'000;
constexpr int kFastestRateHz = 200;

}  // namespace

Sensor::Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns)
    : PolledBarometer(place_on_bus("BMP390", settings.bus, settings.address), std::move(bus),
                      device_silence_ns(settings.rate_hz), stuck_time_ns),
      settings_(settings),
      poll_ns_(poll_interval_ns(settings.rate_hz)),
      measurement_ns_(static_cast<std::int64_t>(
          1e9 * measurement_time_s(settings.pressure_oversampling, settings.temperature_oversampling))) {}

PolledBarometer::Outcome Sensor::start(std::int64_t now_ns) noexcept {
  std::uint8_t id = 0;
  if (const int error = bus().read(kChipId, {&id, 1}); error != 0) return no_answer(error);
  if (id != kBmp390Id) return fault(DeviceState::kWrongDevice, "the chip id is not 0x60: another device");
  if (const int error = bus().write(kCommand, kSoftReset); error != 0) return no_answer(error);
  deadline_ns_ = now_ns + kReadyTimeoutNs;
  return wait(kReadyPollNs);
}

PolledBarometer::Outcome Sensor::set_up(std::int64_t now_ns) noexcept {
  std::uint8_t status = 0;
  const int error = bus().read(kStatus, {&status, 1});
  if (error == 0 && (status & kCommandReady) != 0) return configure();
  if (now_ns < deadline_ns_) return wait(kReadyPollNs);  // a resetting chip does not answer
  if (error != 0) return no_answer(error);
  return fault(DeviceState::kWrongDevice, "not ready 0.05 s after a reset");
}

PolledBarometer::Outcome Sensor::configure() noexcept {
  const char* rule = nullptr;
  int error = read_coefficients(rule);
  if (error == 0 && rule != nullptr) return fault(DeviceState::kWrongDevice, rule);
  if (error == 0) error = write_settings();
  std::uint8_t errors = 0;
  if (error == 0) error = bus().read(kErrors, {&errors, 1});
  if (error != 0) return no_answer(error);
  if ((errors & kConfigError) != 0) {
    return fault(DeviceState::kWrongDevice, "the chip refuses this oversampling at this rate");
  }
  return measuring(poll_ns_, measurement_ns_);
}

int Sensor::read_coefficients(const char*& rule) noexcept {
  CoefficientBytes bytes{};
  std::uint8_t crc = 0;
  if (const int error = bus().read(kCoefficients, bytes); error != 0) return error;
  if (const int error = bus().read(kCoefficientCrc, {&crc, 1}); error != 0) return error;
  rule = implausibility(bytes, crc);
  coefficients_ = decode_coefficients(bytes);
  return 0;
}

int Sensor::write_settings() noexcept {
  const auto filter = std::countr_zero(static_cast<unsigned>(settings_.iir_coefficient) + 1U);
  const std::array<std::array<std::uint8_t, 2>, 4> settings{{
      {kOversampling, static_cast<std::uint8_t>(index_of_power(settings_.temperature_oversampling) << 3U |
                                                index_of_power(settings_.pressure_oversampling))},
      {kRate, index_of_power(kFastestRateHz / settings_.rate_hz)},
      {kConfig, static_cast<std::uint8_t>(filter << 1)},
      {kPowerControl, kNormalMode},
  }};
  for (const auto& [address, value] : settings) {
    if (const int error = write_and_verify(address, value); error != 0) return error;
  }
  return 0;
}

PolledBarometer::Outcome Sensor::read(std::int64_t now_ns, Reading& reading) noexcept {
  constexpr std::uint8_t kReady = kPressureReady | kTemperatureReady;
  std::uint8_t status = 0;
  std::uint8_t control = kNormalMode;
  int error = bus().read(kStatus, {&status, 1});
  const bool ready = (status & kReady) == kReady;
  if (error == 0 && !ready) error = bus().read(kPowerControl, {&control, 1});
  if (error == 0 && control != kNormalMode) return lost_settings();
  std::array<std::uint8_t, kDataBytes> bytes{};
  if (error == 0 && ready) error = read_settled(kData, bytes);
  if (error != 0) return problem(DeviceState::kNoAnswer, "no answer", poll_ns_, error);
  if (!ready) return wait(poll_ns_);
  const RawResult raw = decode_result(bytes);
  const Compensated value = compensate(coefficients_, raw);
  const double noise_pa = pressure_noise_pa(settings_.pressure_oversampling);
  reading.bits = raw.pressure;
  reading.refused = implausibility(raw, value);
  reading.sample.stamp_ns = now_ns - (poll_ns_ + measurement_ns_) / 2;
  reading.sample.pressure_pa = value.pressure_pa;
  reading.sample.temperature_c = value.temperature_c;
  reading.sample.variance_pa2 = noise_pa * noise_pa;
  return result(poll_ns_);
}

}  // namespace isobar::bmp390
