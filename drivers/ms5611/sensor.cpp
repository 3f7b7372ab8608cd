// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ms5611/sensor.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include "drivers/bus/choice.hpp"

namespace isobar::ms5611 {

namespace {

/// The data sheet allows 2.8 ms for the reload of the memory after a reset.
constexpr std::int64_t kReloadNs = 4'000'000;
/// Added to the longest conversion, for the transfers before its command: a read before its end gives 0 and
/// spoils it.
constexpr std::int64_t kSlackNs = 1'000'000;
constexpr std::int64_t kShortestPauseNs = 500'000;

constexpr std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

std::uint8_t convert_command(std::uint8_t command, int oversampling) {
  return static_cast<std::uint8_t>(command + 2 * oversampling_index(oversampling));
}

}  // namespace

Sensor::Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns)
    : PolledBarometer(place_on_bus("MS5611", settings.bus, settings.address), std::move(bus),
                      device_silence_ns(settings.rate_hz), stuck_time_ns),
      settings_(settings),
      period_ns_(1'000'000'000 / settings.rate_hz),
      temperature_wait_ns_(to_ns(longest_conversion_s(settings.temperature_oversampling)) + kSlackNs),
      pressure_wait_ns_(to_ns(longest_conversion_s(settings.pressure_oversampling)) + kSlackNs) {}

PolledBarometer::Outcome Sensor::start(std::int64_t /*now_ns*/) noexcept {
  if (!bus().bursts()) {
    return fault(DeviceState::kNoAnswer, "the bus has no block reads, which this sensor needs", ENOTSUP);
  }
  if (const int error = bus().command(kReset); error != 0) return no_answer(error);
  return wait(kReloadNs);
}

PolledBarometer::Outcome Sensor::set_up(std::int64_t /*now_ns*/) noexcept {
  for (std::size_t word = 0; word < kPromWords; ++word) {
    if (const int error = read_prom(word, prom_[word]); error != 0) return no_answer(error);
  }
  if (const char* rule = implausibility(prom_); rule != nullptr) {
    return fault(DeviceState::kWrongDevice, rule);
  }
  piece_ = Piece::kPause;
  return measuring(kShortestPauseNs, temperature_wait_ns_ + pressure_wait_ns_);
}

PolledBarometer::Outcome Sensor::read(std::int64_t now_ns, Reading& reading) noexcept {
  switch (piece_) {
    case Piece::kTemperature:
      return convert_pressure(now_ns);
    case Piece::kPressure:
      return take_pressure(now_ns, reading);
    default:
      return begin_measurement(now_ns);
  }
}

PolledBarometer::Outcome Sensor::begin_measurement(std::int64_t now_ns) noexcept {
  begun_ns_ = now_ns;
  checked_word_ = checked_word_ % 6 + 1;  // C1 … C6
  std::uint16_t held = 0;
  int error = read_prom(checked_word_, held);
  if (error == 0 && held != prom_[checked_word_]) return lost_settings();
  if (error == 0) {
    error = bus().command(convert_command(kConvertTemperature, settings_.temperature_oversampling));
  }
  if (error != 0) return broken_off(error, now_ns);
  piece_ = Piece::kTemperature;
  return wait(temperature_wait_ns_);
}

PolledBarometer::Outcome Sensor::convert_pressure(std::int64_t now_ns) noexcept {
  int error = read_converter(raw_.temperature);
  if (error == 0) error = bus().command(convert_command(kConvertPressure, settings_.pressure_oversampling));
  if (error != 0) return broken_off(error, now_ns);
  piece_ = Piece::kPressure;
  converting_ns_ = now_ns;
  return wait(pressure_wait_ns_);
}

PolledBarometer::Outcome Sensor::take_pressure(std::int64_t now_ns, Reading& reading) noexcept {
  if (const int error = read_converter(raw_.pressure); error != 0) return broken_off(error, now_ns);
  piece_ = Piece::kPause;
  const Compensated value = compensate(prom_, raw_);
  const double noise_pa = pressure_noise_pa(settings_.pressure_oversampling);
  reading.bits = raw_.pressure;
  reading.refused = implausibility(raw_, value);
  reading.sample.stamp_ns = converting_ns_ + to_ns(conversion_s(settings_.pressure_oversampling)) / 2;
  reading.sample.pressure_pa = value.pressure_pa;
  reading.sample.temperature_c = value.temperature_c;
  reading.sample.variance_pa2 = noise_pa * noise_pa;
  return result(pause_ns(now_ns));
}

PolledBarometer::Outcome Sensor::broken_off(int error, std::int64_t now_ns) noexcept {
  piece_ = Piece::kPause;
  return problem(DeviceState::kNoAnswer, "no answer", pause_ns(now_ns), error);
}

std::int64_t Sensor::pause_ns(std::int64_t now_ns) const noexcept {
  return std::max(begun_ns_ + period_ns_ - now_ns, kShortestPauseNs);
}

int Sensor::read_prom(std::size_t word, std::uint16_t& value) noexcept {
  std::array<std::uint8_t, 2> bytes{};
  const int error = bus().read(static_cast<std::uint8_t>(kReadProm + 2 * word), bytes);
  if (error == 0) value = static_cast<std::uint16_t>(bytes[0] << 8U | bytes[1]);
  return error;
}

int Sensor::read_converter(std::uint32_t& value) noexcept {
  std::array<std::uint8_t, kAdcBytes> bytes{};
  const int error = bus().read(kReadAdc, bytes);
  if (error == 0) value = static_cast<std::uint32_t>(bytes[0] << 16U | bytes[1] << 8U | bytes[2]);
  return error;
}

}  // namespace isobar::ms5611
