// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/icp20100/sensor.hpp"

#include <array>
#include <cerrno>

#include "drivers/bus/choice.hpp"

namespace isobar::icp20100 {

namespace {

/// Waits after a change of mode: 2 ms to standby, 4 ms until the memory has its supply (data sheet 6.5).
constexpr std::int64_t kStandbyNs = 3'000'000;
constexpr std::int64_t kPowerNs = 5'000'000;
constexpr std::int64_t kBusyPollNs = 2'000'000;
constexpr std::int64_t kBusyTimeoutNs = 100'000'000;
/// Step after which the next waiting result is read.
constexpr std::int64_t kCatchUpNs = 1'000'000;
/// Polls of the memory's status; one takes longer on any bus than the 20 us that a read needs.
constexpr int kMemoryPolls = 20;

}  // namespace

Sensor::Sensor(const Settings& settings, std::unique_ptr<RegisterBus> bus, std::int64_t stuck_time_ns)
    : PolledBarometer(place_on_bus("ICP-20100", settings.bus, settings.address), std::move(bus),
                      device_silence_ns(mode_of(settings.rate_hz).rate_hz), stuck_time_ns),
      mode_(mode_of(settings.rate_hz)),
      period_ns_(1'000'000'000 / mode_.rate_hz),
      poll_ns_(poll_interval_ns(mode_.rate_hz)),
      variance_pa2_(white_variance_pa2(mode_)) {}

std::uint8_t Sensor::running_mode() const noexcept {
  return static_cast<std::uint8_t>(mode_.number << 5U | kModeContinuous);
}

PolledBarometer::Outcome Sensor::start(std::int64_t now_ns) noexcept {
  if (!bus().bursts()) {
    return fault(DeviceState::kNoAnswer, "the bus has no block reads, which this FIFO needs", ENOTSUP);
  }
  std::uint8_t id = 0;
  if (const int error = bus().read(kDeviceId, {&id, 1}); error != 0) return no_answer(error);
  if (id != kIcp20100Id) return fault(DeviceState::kWrongDevice, "the device id is not 0x63: another device");
  piece_ = Piece::kStandby;
  deadline_ns_ = now_ns + kBusyTimeoutNs;
  return wait(kBusyPollNs);
}

PolledBarometer::Outcome Sensor::set_up(std::int64_t now_ns) noexcept {
  if (piece_ == Piece::kSettle) return settle(now_ns);
  // The mode may be changed only when the last change has reached the chip's sequencer.
  std::uint8_t status = 0;
  if (const int error = bus().read(kDeviceStatus, {&status, 1}); error != 0) return no_answer(error);
  if ((status & kModeAccessible) == 0) {
    if (now_ns < deadline_ns_) return wait(kBusyPollNs);
    return fault(DeviceState::kSilent, "the mode cannot be set: busy for 0.1 s");
  }
  switch (piece_) {
    case Piece::kLook:
      return look_at_version();
    case Piece::kBoot:
      return boot();
    case Piece::kConfigure:
      return configure(now_ns);
    default:
      return select(kModeStandby, Piece::kLook, kStandbyNs);
  }
}

PolledBarometer::Outcome Sensor::select(std::uint8_t mode, Piece next, std::int64_t wait_ns) noexcept {
  if (const int error = write_and_verify(kModeSelect, mode); error != 0) return no_answer(error);
  piece_ = next;
  return wait(wait_ns);
}

PolledBarometer::Outcome Sensor::look_at_version() noexcept {
  std::uint8_t version = 0;
  std::uint8_t booted = 0;
  int error = bus().read(kVersion, {&version, 1});
  if (error == 0) error = bus().read(kOtpStatus2, {&booted, 1});
  if (error != 0) return no_answer(error);
  if (version == kVersionA && (booted & kBooted) == 0) return select(kModePowered, Piece::kBoot, kPowerNs);
  piece_ = Piece::kConfigure;
  return wait(kStandbyNs);
}

/// Boot sequence of version A, once after power-up (data sheet 6.5): copies the trimming from the one-time
/// programmable memory, whose read parameters are the manufacturer's. The waits of 10 us between its steps
/// pass during the transfers.
PolledBarometer::Outcome Sensor::boot() noexcept {
  constexpr std::array<std::array<std::uint8_t, 2>, 6> kReadParameters{{{kOtpMraLsb, 0x04},
                                                                        {kOtpMraMsb, 0x04},
                                                                        {kOtpMrbLsb, 0x21},
                                                                        {kOtpMrbMsb, 0x20},
                                                                        {kOtpMrLsb, 0x10},
                                                                        {kOtpMrMsb, 0x80}}};
  std::uint8_t offset = 0;
  std::uint8_t gain = 0;
  std::uint8_t oscillator = 0;
  int error = bus().write(kMasterLock, kUnlock);
  if (error == 0) error = change(kOtpConfig1, 0, kOtpEnable);
  if (error == 0) error = change(kOtpConfig1, 0, kOtpWriteSwitch);
  if (error == 0) error = change(kOtpDebug2, 0, kOtpReset);
  if (error == 0) error = change(kOtpDebug2, kOtpReset, 0);
  for (const auto& [address, value] : kReadParameters) {
    if (error == 0) error = bus().write(address, value);
  }
  if (error == 0) error = read_trimming(kOtpOffset, offset);
  if (error == 0) error = read_trimming(kOtpGain, gain);
  if (error == 0) error = read_trimming(kOtpOscillator, oscillator);
  if (error == 0) error = change(kTrim1Msb, kOffsetMask, offset & kOffsetMask);
  if (error == 0) error = change(kTrim2Msb, kGainMask, static_cast<std::uint8_t>(gain << 4U) & kGainMask);
  if (error == 0) error = change(kTrim2Lsb, kOscillatorMask, oscillator & kOscillatorMask);
  if (error == 0) error = change(kOtpConfig1, kOtpEnable | kOtpWriteSwitch, 0);
  if (error == 0) error = bus().write(kMasterLock, 0);
  if (error == 0) error = change(kOtpStatus2, 0, kBooted);
  if (error != 0) return no_answer(error);
  return select(kModeStandby, Piece::kConfigure, kStandbyNs);
}

int Sensor::read_trimming(std::uint8_t address, std::uint8_t& value) noexcept {
  int error = bus().write(kOtpAddress, address);
  if (error == 0) error = bus().write(kOtpCommand, kOtpRead);
  std::uint8_t busy = 1;
  for (int polls = 0; error == 0 && busy != 0; ++polls) {
    if (polls == kMemoryPolls) return ETIMEDOUT;
    error = bus().read(kOtpStatus, {&busy, 1});
  }
  if (error == 0) error = bus().read(kOtpData, {&value, 1});
  return error;
}

int Sensor::change(std::uint8_t address, std::uint8_t clear, std::uint8_t set) noexcept {
  std::uint8_t value = 0;
  if (const int error = bus().read(address, {&value, 1}); error != 0) return error;
  return bus().write(address, static_cast<std::uint8_t>((value & ~clear) | set));
}

PolledBarometer::Outcome Sensor::configure(std::int64_t now_ns) noexcept {
  constexpr std::uint8_t kAll = 0xFF;
  int error = bus().write(kFifoFill, kFlush);
  if (error == 0) error = write_and_verify(kFifoConfig, 0);
  if (error == 0) error = bus().write(kInterruptMask, kAll);
  if (error == 0) error = bus().write(kInterruptStatus, kAll);
  if (error != 0) return no_answer(error);
  deadline_ns_ = now_ns + kBusyTimeoutNs + std::int64_t{2} * kSettlingResults * period_ns_;
  return select(running_mode(), Piece::kSettle, kSettlingResults * period_ns_);
}

PolledBarometer::Outcome Sensor::settle(std::int64_t now_ns) noexcept {
  std::uint8_t fill = 0;
  if (const int error = bus().read(kFifoFill, {&fill, 1}); error != 0) return no_answer(error);
  if ((fill & kFillMask) < kSettlingResults) {
    if (now_ns < deadline_ns_) return wait(poll_ns_);
    return fault(DeviceState::kSilent, "no results after the start");
  }
  if (const int error = bus().write(kFifoFill, kFlush); error != 0) return no_answer(error);
  return measuring(poll_ns_, period_ns_);
}

PolledBarometer::Outcome Sensor::read(std::int64_t now_ns, Reading& reading) noexcept {
  std::array<std::uint8_t, kFifoFill - kModeSelect + 1> state{};
  std::array<std::uint8_t, kResultBytes> bytes{};
  std::uint8_t dummy = 0;
  int error = bus().read(kModeSelect, state);
  if (error != 0) return problem(DeviceState::kNoAnswer, "no answer", poll_ns_, error);
  if (state.front() != running_mode()) return lost_settings();
  const int waiting = state.back() & kFillMask;
  if (waiting == 0) return wait(poll_ns_);
  if (waiting >= kFifoDepth) {  // full: results were lost, and the age of the others is unknown
    error = bus().write(kFifoFill, kFlush);
    return error == 0 ? wait(poll_ns_) : problem(DeviceState::kNoAnswer, "no answer", poll_ns_, error);
  }
  error = bus().read(kFifo, bytes);
  if (error == 0) error = bus().read(kDummy, {&dummy, 1});
  if (error != 0) return problem(DeviceState::kNoAnswer, "no answer", poll_ns_, error);
  const RawResult raw = decode_result(bytes);
  const Converted value = convert(raw);
  reading.bits = raw.pressure;
  reading.refused = implausibility(raw, value);
  reading.sample.stamp_ns = now_ns - poll_ns_ / 2 - (waiting - 1 + kSettlingResults / 2) * period_ns_;
  reading.sample.pressure_pa = value.pressure_pa;
  reading.sample.temperature_c = value.temperature_c;
  reading.sample.variance_pa2 = variance_pa2_;
  return result(waiting > 1 ? kCatchUpNs : poll_ns_);
}

}  // namespace isobar::icp20100
