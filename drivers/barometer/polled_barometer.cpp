// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/barometer/polled_barometer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

namespace isobar {

namespace {

constexpr std::int64_t kFastestPollNs = 4'000'000;
constexpr std::int64_t kSlowestPollNs = 20'000'000;
/// Largest number of reads of one result until two agree.
constexpr int kMaxReads = 4;
constexpr std::size_t kMaxRegisters = 32;

}  // namespace

std::int64_t poll_interval_ns(int rate_hz) noexcept {
  return std::clamp(std::int64_t{250'000'000} / rate_hz, kFastestPollNs, kSlowestPollNs);
}

PolledBarometer::PolledBarometer(std::string place, std::unique_ptr<RegisterBus> bus, std::int64_t silence_ns,
                                 std::int64_t stuck_time_ns)
    : place_(std::move(place)), bus_(std::move(bus)), faults_(silence_ns), stuck_(stuck_time_ns) {}

PolledBarometer::Outcome PolledBarometer::wait(std::int64_t wait_ns) noexcept {
  Outcome outcome;
  outcome.wait_ns = wait_ns;
  return outcome;
}

PolledBarometer::Outcome PolledBarometer::measuring(std::int64_t wait_ns,
                                                    std::int64_t first_result_ns) noexcept {
  Outcome outcome = wait(wait_ns);
  outcome.kind = Outcome::Kind::kMeasuring;
  outcome.first_result_ns = first_result_ns;
  return outcome;
}

PolledBarometer::Outcome PolledBarometer::result(std::int64_t wait_ns) noexcept {
  Outcome outcome = wait(wait_ns);
  outcome.kind = Outcome::Kind::kResult;
  return outcome;
}

PolledBarometer::Outcome PolledBarometer::problem(DeviceState state, const char* what, std::int64_t wait_ns,
                                                  int error) noexcept {
  Outcome outcome = fault(state, what, error);
  outcome.kind = Outcome::Kind::kProblem;
  outcome.wait_ns = wait_ns;
  return outcome;
}

PolledBarometer::Outcome PolledBarometer::fault(DeviceState state, const char* what, int error) noexcept {
  Outcome outcome;
  outcome.kind = Outcome::Kind::kFault;
  outcome.state = state;
  outcome.what = what;
  outcome.error = error;
  return outcome;
}

PolledBarometer::Outcome PolledBarometer::no_answer(int error) noexcept {
  return fault(DeviceState::kNoAnswer, "no answer", error);
}

PolledBarometer::Outcome PolledBarometer::lost_settings() noexcept {
  Outcome outcome = fault(DeviceState::kSilent, "lost its settings (power failure?)");
  outcome.lost_settings = true;
  return outcome;
}

Device<PressureSample>::Step PolledBarometer::step(std::int64_t now_ns) noexcept {
  Step step;
  switch (phase_) {
    case Phase::kBegin:
      step.next_ns = begin(now_ns);
      break;
    case Phase::kSettingUp:
      step.next_ns = proceed(set_up(now_ns), now_ns);
      break;
    case Phase::kMeasuring:
      measure(now_ns, step);
      break;
  }
  return step;
}

std::int64_t PolledBarometer::begin(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  if (const int error = bus_->open(); error != 0) {
    const char* what = error == EBUSY     ? "a kernel driver holds the device"
                       : error == ENOTSUP ? "the bus has no SMBus byte reads and writes"
                                          : "the bus cannot be opened";
    return restart(fault(DeviceState::kNoAnswer, what, error), now_ns);
  }
  phase_ = Phase::kSettingUp;
  return proceed(start(now_ns), now_ns);
}

std::int64_t PolledBarometer::proceed(const Outcome& outcome, std::int64_t now_ns) noexcept {
  if (outcome.kind == Outcome::Kind::kFault) return restart(outcome, now_ns);
  if (outcome.kind == Outcome::Kind::kMeasuring) {
    phase_ = Phase::kMeasuring;
    faults_.expects_results(now_ns + outcome.first_result_ns);
  }
  return now_ns + outcome.wait_ns;
}

void PolledBarometer::measure(std::int64_t now_ns, Step& step) noexcept {
  Reading reading;
  const Outcome outcome = read(now_ns, reading);
  step.next_ns = now_ns + outcome.wait_ns;
  switch (outcome.kind) {
    case Outcome::Kind::kFault:
      step.next_ns = restart(outcome, now_ns);
      return;
    case Outcome::Kind::kProblem:
      if (outcome.state == DeviceState::kNoAnswer) ++faults_.counters().io_errors;
      faults_.problem(outcome.state, outcome.what, outcome.error);
      break;
    case Outcome::Kind::kResult:
      take(reading, now_ns, step);
      break;
    default:
      break;
  }
  if (phase_ == Phase::kMeasuring && faults_.overdue(now_ns)) {
    phase_ = Phase::kBegin;
    step.next_ns = faults_.give_up(now_ns);
  }
}

void PolledBarometer::take(const Reading& reading, std::int64_t now_ns, Step& step) noexcept {
  if (stuck_.add(reading.bits, now_ns)) {
    if (status().state != DeviceState::kStuck) ++faults_.counters().stuck;
    step.next_ns = restart(fault(DeviceState::kStuck, "the result no longer changes"), now_ns);
    return;
  }
  if (reading.refused != nullptr) {
    if (reading.refused_state == DeviceState::kImplausible) ++faults_.counters().implausible;
    faults_.problem(reading.refused_state, reading.refused);
    return;
  }
  faults_.good(now_ns);
  step.has_sample = true;
  step.sample = reading.sample;
  step.sample.timing.received_ns = now_ns;
}

std::int64_t PolledBarometer::restart(const Outcome& outcome, std::int64_t now_ns) noexcept {
  phase_ = Phase::kBegin;
  if (outcome.state == DeviceState::kNoAnswer) ++faults_.counters().io_errors;
  if (outcome.lost_settings) ++faults_.counters().resets;
  return faults_.fail(outcome.state, outcome.what, now_ns, outcome.error);
}

int PolledBarometer::write_and_verify(std::uint8_t address, std::uint8_t value, std::uint8_t mask) noexcept {
  std::uint8_t held = 0;
  if (const int error = bus_->write(address, value); error != 0) return error;
  if (const int error = bus_->read(address, {&held, 1}); error != 0) return error;
  return ((held ^ value) & mask) == 0 ? 0 : EIO;
}

int PolledBarometer::read_settled(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept {
  if (bytes.size() > kMaxRegisters) return EINVAL;
  std::array<std::uint8_t, kMaxRegisters> before{};
  if (const int error = bus_->read(first, bytes); error != 0) return error;
  for (int reads = 1; reads <= kMaxReads; ++reads) {
    std::copy(bytes.begin(), bytes.end(), before.begin());
    if (const int error = bus_->read(first, bytes); error != 0) return error;
    if (std::equal(bytes.begin(), bytes.end(), before.begin())) return 0;
    ++faults_.counters().torn;
  }
  return EAGAIN;  // results change faster than these settings allow
}

}  // namespace isobar
