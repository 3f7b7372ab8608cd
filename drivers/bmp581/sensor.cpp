// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bmp581/sensor.hpp"

#include <array>
#include <bit>

#include "drivers/bus/choice.hpp"

namespace isobar::bmp581 {

namespace {

/// The data sheet allows 2 ms for a soft reset (t_soft_res) and 2.5 ms to standby (t_standby).
constexpr std::int64_t kReadyPollNs = 3'000'000;
constexpr std::int64_t kReadyTimeoutNs = 50'000'000;
constexpr std::int64_t kStandbyNs = 4'000'000;

}  // namespace

Sensor::Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns)
    : PolledBarometer(place_on_bus("BMP581", settings.bus, settings.address), std::move(bus),
                      device_silence_ns(settings.rate_hz), stuck_time_ns),
      settings_(settings),
      poll_ns_(poll_interval_ns(settings.rate_hz)),
      measurement_ns_(static_cast<std::int64_t>(1e9 * busy_time_s(settings) / settings.rate_hz)) {}

PolledBarometer::Outcome Sensor::start(std::int64_t now_ns) noexcept {
  std::uint8_t id = 0;
  // Read twice: the first access after power-up selects SPI and its answer is undefined (data sheet 5.1).
  for (int reads = 0; reads < 2; ++reads) {
    if (const int error = bus().read(kChipId, {&id, 1}); error != 0) return no_answer(error);
  }
  if (id != kBmp581Id) return fault(DeviceState::kWrongDevice, "the chip id is not 0x50: another device");
  if (const int error = bus().write(kCommand, kSoftReset); error != 0) return no_answer(error);
  piece_ = Piece::kWaitReady;
  deadline_ns_ = now_ns + kReadyTimeoutNs;
  return wait(kReadyPollNs);
}

PolledBarometer::Outcome Sensor::set_up(std::int64_t now_ns) noexcept {
  return piece_ == Piece::kWaitReady ? wait_ready(now_ns) : configure();
}

PolledBarometer::Outcome Sensor::wait_ready(std::int64_t now_ns) noexcept {
  std::uint8_t id = 0;
  std::uint8_t status = 0;
  int error = bus().read(kChipId, {&id, 1});  // as above: the reset has made the interface undecided, too
  if (error == 0) error = bus().read(kStatus, {&status, 1});
  if (error == 0 && (status & kNvmError) != 0) {
    return fault(DeviceState::kWrongDevice, "the chip reports a damaged memory");
  }
  if (error == 0 && (status & kNvmReady) != 0) {
    // Leaves deep standby, in which the filter cannot be set (data sheet 4.3.2).
    error = bus().write(kOdrConfig, odr_config(kModeStandby));
    if (error != 0) return no_answer(error);
    piece_ = Piece::kConfigure;
    return wait(kStandbyNs);
  }
  if (now_ns < deadline_ns_) return wait(kReadyPollNs);  // a resetting chip does not answer
  if (error != 0) return no_answer(error);
  return fault(DeviceState::kWrongDevice, "the memory is not loaded 0.05 s after a reset");
}

PolledBarometer::Outcome Sensor::configure() noexcept {
  std::uint8_t dsp = 0;
  std::uint8_t interrupts = 0;
  const auto filter = static_cast<std::uint8_t>(std::countr_zero(
      static_cast<unsigned>(settings_.iir_coefficient) + 1U));  // 0, 1, 3, 7 … to 0, 1, 2, 3 …
  int error = bus().read(kDspConfig, {&dsp, 1});
  if (error == 0) error = write_and_verify(kDspConfig, dsp | kDataFiltered);
  if (error == 0) {
    error = write_and_verify(kDspIir, static_cast<std::uint8_t>(filter << 3U | filter));
  }
  if (error == 0) {
    error = write_and_verify(
        kOsrConfig,
        static_cast<std::uint8_t>(kPressureEnable | index_of_power(settings_.pressure_oversampling) << 3U |
                                  index_of_power(settings_.temperature_oversampling)));
  }
  if (error == 0) error = write_and_verify(kIntSource, kDataReady);
  if (error == 0) error = bus().read(kIntStatus, {&interrupts, 1});  // clears what the reset left
  if (error == 0) error = write_and_verify(kOdrConfig, odr_config(kModeNormal));
  std::uint8_t effective = 0;
  if (error == 0) error = bus().read(kOsrEffective, {&effective, 1});
  if (error != 0) return no_answer(error);
  if ((effective & kRateValid) == 0) {
    return fault(DeviceState::kWrongDevice, "the chip refuses this oversampling at this rate");
  }
  return measuring(poll_ns_, measurement_ns_);
}

std::uint8_t Sensor::odr_config(std::uint8_t mode) const noexcept {
  return static_cast<std::uint8_t>(kDeepDisable | rate_code(settings_.rate_hz) << 2U | mode);
}

PolledBarometer::Outcome Sensor::read(std::int64_t now_ns, Reading& reading) noexcept {
  std::uint8_t interrupts = 0;
  std::uint8_t config = odr_config(kModeNormal);
  int error = bus().read(kIntStatus, {&interrupts, 1});
  const bool ready = (interrupts & kDataReady) != 0;
  if (error == 0 && !ready) error = bus().read(kOdrConfig, {&config, 1});
  if (error == 0 && ((interrupts & kResetComplete) != 0 || config != odr_config(kModeNormal))) {
    return lost_settings();
  }
  std::array<std::uint8_t, kDataBytes> bytes{};
  if (error == 0 && ready) error = read_settled(kTemperatureData, bytes);
  if (error != 0) return problem(DeviceState::kNoAnswer, "no answer", poll_ns_, error);
  if (!ready) return wait(poll_ns_);
  const RawResult raw = decode_result(bytes);
  const Converted value = convert(raw);
  const double noise_pa = pressure_noise_pa(settings_.pressure_oversampling);
  reading.bits = raw.pressure;
  reading.refused = implausibility(raw, value);
  reading.sample.stamp_ns = now_ns - (poll_ns_ + measurement_ns_) / 2;
  reading.sample.pressure_pa = value.pressure_pa;
  reading.sample.temperature_c = value.temperature_c;
  reading.sample.variance_pa2 = noise_pa * noise_pa;
  return result(poll_ns_);
}

}  // namespace isobar::bmp581
