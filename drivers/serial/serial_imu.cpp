// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/serial/serial_imu.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>

#include "core/plausibility.hpp"

namespace isobar::serial {

namespace {

/// Time for an answer [ns], and the number of times that a command is sent.
constexpr std::int64_t kAnswerNs = 200'000'000;
constexpr int kTries = 3;
/// Pause after which an incomplete message stays so [ns]: longer than the 16 ms for which an adapter without
/// the low-latency flag holds bytes back.
constexpr std::int64_t kPauseNs = 40'000'000;
/// Shortest time without a measurement that is silence [ns]: above kPauseNs, and with the 0.1 s of isobard's
/// supervision said within 0.2 s.
constexpr std::int64_t kSilenceNs = 80'000'000;
/// Limit of the back-off [ns]: a sensor that returns must measure within 2 s.
constexpr std::int64_t kLongestWaitNs = 500'000'000;
/// Interval at which a pressure that does not change is delivered again [ns]: sensors repeat one conversion in
/// several messages, and a coarse converter repeats its value in calm air.
constexpr std::int64_t kRepeatNs = 100'000'000;
/// Added to a deadline [ns], so that the next step comes after it.
constexpr std::int64_t kAfterNs = 1'000'000;

std::int64_t silence_of(int rate_hz) {
  return std::max(kSilenceNs, 4 * std::int64_t{1'000'000'000} / rate_hz);
}

ClockAnchorConfig clock_of(const ImuProtocol& protocol) {
  ClockAnchorConfig config;
  config.period_ns = protocol.clock_period_ns();
  return config;
}

const char* open_fault(int error) {
  switch (error) {
    case ENOENT:
      return "no such port";
    case EBUSY:
      return "another program holds the port";
    case EACCES:
      return "no right to open the port: a member of the group dialout has it";
    case ERANGE:
      return "the port cannot do this baud rate";
    default:
      return "the port cannot be opened";
  }
}

}  // namespace

SerialImu::SerialImu(const std::string& name, const std::string& port, int baud, int rate_hz,
                     std::unique_ptr<ImuProtocol> protocol)
    : place_(name + " on " + port),
      port_(port, baud),
      protocol_(std::move(protocol)),
      silence_ns_(silence_of(rate_hz)),
      faults_(silence_ns_, kLongestWaitNs),
      anchor_(clock_of(*protocol_)) {}

Device<InertialReading>::Step SerialImu::step(std::int64_t now_ns) noexcept {
  Step step;
  switch (phase_) {
    case Phase::kClosed:
      step.next_ns = open(now_ns);
      break;
    case Phase::kDialogue:
      step.next_ns = converse(now_ns);
      break;
    case Phase::kMeasuring:
      measure(now_ns, step);
  }
  faults_.counters().corrupt = protocol_->corrupt();
  return step;
}

std::int64_t SerialImu::open(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  if (const int error = port_.open(); error != 0) {
    ++faults_.counters().io_errors;
    return fail(DeviceState::kNoAnswer, open_fault(error), now_ns, error);
  }
  faults_.note(port_.low_latency() ? "the port is in low-latency mode"
                                   : "the port has no low-latency mode: bytes may come 16 ms late");
  protocol_->restart();
  anchor_ = ClockAnchor(clock_of(*protocol_));
  heard_bytes_ = false;
  heard_messages_ = false;
  tries_ = 0;
  received_ns_ = now_ns;
  return protocol_->command().empty() ? begin_measuring(now_ns) : send(now_ns);
}

std::int64_t SerialImu::begin_measuring(std::int64_t now_ns) noexcept {
  phase_ = Phase::kMeasuring;
  newest_good_ns_ = now_ns;
  faults_.expects_results(now_ns);
  return now_ns;
}

std::int64_t SerialImu::send(std::int64_t now_ns) noexcept {
  phase_ = Phase::kDialogue;
  deadline_ns_ = now_ns + kAnswerNs;
  ++tries_;
  const int error = port_.write(protocol_->command());
  if (error == 0 || error == EAGAIN) return deadline_ns_;
  ++faults_.counters().io_errors;
  return fail(DeviceState::kNoAnswer, "the port takes no bytes", now_ns, error);
}

std::int64_t SerialImu::converse(std::int64_t now_ns) noexcept {
  for (;;) {
    int error = 0;
    const ImuEvent event = next_event(now_ns, error);
    if (error != 0) return fail(DeviceState::kNoAnswer, "unplugged", now_ns, error);
    if (event.kind == ImuEvent::Kind::kNone) break;
    heard_messages_ = true;
    if (event.kind == ImuEvent::Kind::kRefusal) {
      return fail(DeviceState::kWrongDevice, protocol_->refusal(), now_ns);
    }
    if (event.kind == ImuEvent::Kind::kAnswer) {
      tries_ = 0;
      return protocol_->command().empty() ? begin_measuring(now_ns) : send(now_ns);
    }
  }
  if (now_ns < deadline_ns_) return deadline_ns_;
  return tries_ < kTries ? send(now_ns) : no_answer(now_ns);
}

std::int64_t SerialImu::no_answer(std::int64_t now_ns) noexcept {
  const char* why = "nothing comes: power, wiring?";
  if (heard_messages_) {
    why = "it sends, but does not hear: transmit wire?";
  } else if (heard_bytes_) {
    why = "bytes without sense: baud rate?";
  }
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "no answer to %s; %s", protocol_->command_name(), why);
  return fail(DeviceState::kNoAnswer, text.data(), now_ns);
}

int SerialImu::receive(std::int64_t now_ns) noexcept {
  const Port::Result read = port_.read(protocol_->room());
  if (read.count > 0) {
    protocol_->filled(read.count);
    received_ns_ = now_ns;
    heard_bytes_ = true;
  } else if (read.error == 0 && now_ns - received_ns_ > kPauseNs) {
    protocol_->give_up_incomplete();
  }
  if (read.error != 0) ++faults_.counters().io_errors;
  return read.error;
}

ImuEvent SerialImu::next_event(std::int64_t now_ns, int& error) noexcept {
  ImuEvent event = protocol_->next();
  if (event.kind != ImuEvent::Kind::kNone) return event;
  error = receive(now_ns);
  return error == 0 ? protocol_->next() : event;
}

void SerialImu::measure(std::int64_t now_ns, Step& step) noexcept {
  for (;;) {
    int error = 0;
    const ImuEvent event = next_event(now_ns, error);
    if (error != 0) {
      step.next_ns = fail(DeviceState::kNoAnswer, "unplugged", now_ns, error);
      return;
    }
    if (event.kind == ImuEvent::Kind::kNone) break;
    if (event.complaint != nullptr) faults_.problem(DeviceState::kSilent, event.complaint);
    if (event.kind == ImuEvent::Kind::kReading && take_reading(event, now_ns, step)) return;
  }
  step.next_ns = std::min(newest_good_ns_ + silence_ns_ + kAfterNs, received_ns_ + kPauseNs + kAfterNs);
  if (step.next_ns <= now_ns) step.next_ns = now_ns + kPauseNs;  // the pause was dealt with
  if (!faults_.overdue(now_ns)) return;
  if (const char* heard = protocol_->heard_instead(); heard != nullptr) {
    faults_.problem(DeviceState::kSilent, heard);
  }
  phase_ = Phase::kClosed;
  port_.close();
  step.next_ns = faults_.give_up(now_ns);
}

/// True when the step is done: it has a sample, or the device failed.
bool SerialImu::take_reading(const ImuEvent& event, std::int64_t now_ns, Step& step) noexcept {
  InertialReading reading = event.reading;
  const std::int64_t stamp_ns = stamp_of(event);
  reading.imu.stamp_ns = reading.pressure.stamp_ns = stamp_ns;
  reading.imu.timing = {.received_ns = received_ns_};
  if (event.has_device_time) reading.imu.timing.clock_ahead_ns = anchor_.device_ahead_ns();
  reading.pressure.timing = reading.imu.timing;
  if (reading.has_pressure) take_pressure(reading);
  if (reading.has_imu) {
    switch (watch_.judge(reading.imu, now_ns, faults_)) {
      case InertialWatch::Verdict::kGood:
        newest_good_ns_ = now_ns;
        break;
      case InertialWatch::Verdict::kRefused:
        reading.has_imu = false;
        break;
      case InertialWatch::Verdict::kStuck:
        step.next_ns = fail(DeviceState::kStuck, "the values no longer change", now_ns);
        return true;
    }
  }
  if (!reading.has_imu && !reading.has_pressure) return false;
  step.has_sample = true;
  step.sample = reading;
  step.next_ns = now_ns;  // more may be waiting
  return true;
}

/// Keeps the pressure of a reading only if it is plausible and new; see kRepeatNs.
void SerialImu::take_pressure(InertialReading& reading) noexcept {
  const PressureSample& sample = reading.pressure;
  const bool repeated = sample.pressure_pa == pressure_pa_ && sample.stamp_ns - pressure_ns_ < kRepeatNs;
  reading.has_pressure = !repeated;
  if (repeated) return;
  if (implausibility(sample) != nullptr) {
    ++faults_.counters().implausible;
    reading.has_pressure = false;
    return;
  }
  pressure_pa_ = sample.pressure_pa;
  pressure_ns_ = sample.stamp_ns;
}

std::int64_t SerialImu::stamp_of(const ImuEvent& event) noexcept {
  const std::int64_t sent_ns = received_ns_ - port_.line_time_ns(event.bytes_on_line);
  if (!event.has_device_time) return sent_ns;
  (void)anchor_.add(event.device_ns, sent_ns);
  return anchor_.to_host_ns(anchor_.device_unwrapped_ns());
}

std::int64_t SerialImu::fail(DeviceState state, const char* what, std::int64_t now_ns, int error) noexcept {
  phase_ = Phase::kClosed;
  port_.close();
  return faults_.fail(state, what, now_ns, error);
}

}  // namespace isobar::serial
