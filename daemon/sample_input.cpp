// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sample_input.hpp"

#include <algorithm>
#include <sstream>

namespace isobar {

std::vector<std::uint32_t> addresses_of(const std::string& senders) {
  std::vector<std::uint32_t> addresses;
  std::istringstream stream(senders);
  for (std::string word; std::getline(stream, word, ',');) {
    word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
    if (const std::uint32_t address = ipv4_of(word); address != 0) addresses.push_back(address);
  }
  return addresses;
}

SampleInput::SampleInput(Takes takes, std::vector<std::uint32_t> allowed)
    : takes_(takes), allowed_(std::move(allowed)) {}

void SampleInput::begin(const ReceivedDatagram& received, const SystemClockWatch& system) noexcept {
  from_ = received.sender;
  receive_ns_ = received.stamp_ns;
  system_ = &system;
  const bool is_allowed =
      allowed_.empty() || std::find(allowed_.begin(), allowed_.end(), from_.ipv4) != allowed_.end();
  if (!is_allowed) {
    ++status_.not_allowed;
    status_.not_allowed_ipv4 = from_.ipv4;
  }
  parser_.begin(is_allowed ? received.payload : std::span<const std::uint8_t>{});
}

bool SampleInput::next(datagram::Sample& sample) noexcept {
  const auto admit = [this](const datagram::Sample& line, datagram::LineStatus status) {
    return admission(line, status);
  };
  while (parser_.next(sample, admit)) {
    if (to_robot_clock(sample)) return true;
  }
  return false;
}

// Before the sequence numbers: those of another sender would make good samples look repeated or lost.
datagram::Admission SampleInput::admission(const datagram::Sample& sample,
                                           datagram::LineStatus status) noexcept {
  using datagram::Admission;
  if (takes_.base_station_only && sample.kind != datagram::Kind::kPressure) {
    ++status_.not_of_this_role;
    return Admission::kSkip;
  }
  if (const std::array takes{takes_.imu, takes_.barometer, true, takes_.wheel};
      !takes[static_cast<std::size_t>(sample.kind)]) {
    ++status_.refused[static_cast<std::size_t>(sample.kind)];
    return Admission::kSkip;
  }
  if (sample.kind == datagram::Kind::kBasePressure) {
    if (takes_.unsigned_base) return base_admission();
    ++status_.unsigned_base;
    return Admission::kSkip;
  }
  SenderLock& sender = streams_[static_cast<std::size_t>(sample.kind)].sender;
  if (status != datagram::LineStatus::kOk) {
    // Only a good line makes a sender known.
    return sender.is_in_use(from_) ? Admission::kInSequence : Admission::kWithoutSequence;
  }
  const std::uint64_t takeovers = sender.status().takeovers;
  if (!sender.admits(from_, receive_ns_)) return Admission::kSkip;
  if (sender.status().takeovers != takeovers) parser_.restart(sample.kind);
  return Admission::kInSequence;
}

// BaseStationStream chooses among base stations; the sequence numbers are those of the chosen one.
datagram::Admission SampleInput::base_admission() noexcept {
  if (base_.sender() != base_sender_) parser_.restart(datagram::Kind::kBasePressure);
  base_sender_ = base_.sender();
  const bool is_chosen = base_sender_ == 0 || base_sender_ == from_.ipv4;
  return is_chosen ? datagram::Admission::kInSequence : datagram::Admission::kWithoutSequence;
}

// False for a base-station sample that BaseStationStream refuses (old, repeated, another sender).
bool SampleInput::to_robot_clock(datagram::Sample& sample) noexcept {
  const bool stamped = sample.stamp_ns() != 0;
  if (!stamped) sample.set_stamp_ns(receive_ns_);
  sample.imu.timing = sample.wheel.timing = sample.pressure.timing = {.received_ns = receive_ns_};
  sample.imu.path = sample.wheel.path = SamplePath::kDatagram;
  if (sample.kind == datagram::Kind::kBasePressure) {
    sample.pressure.path = SamplePath::kDatagram;
    return base_.check(from_.ipv4, sample.pressure, receive_ns_, stamped ? system_ : nullptr) ==
           BaseVerdict::kAccepted;
  }
  const bool is_imu = sample.kind == datagram::Kind::kImu;
  if (is_imu) imu_beginnings_.add_number(sample.sequence, receive_ns_);
  if (stamped) to_robot_clock(streams_[static_cast<std::size_t>(sample.kind)], sample);
  if (is_imu && imu_beginnings_.take()) status_.imu_began_ns = receive_ns_;
  return true;
}

void SampleInput::to_robot_clock(Stream& stream, datagram::Sample& sample) noexcept {
  const std::int64_t expected_ns = receive_ns_ - stream.anchor.offset_ns();
  const std::int64_t sender_ns =
      stream.clock.without_steps_ns(sample.stamp_ns(), expected_ns, stream.anchored, *system_);
  if (sample.kind == datagram::Kind::kImu) imu_beginnings_.add_stamp(sender_ns, receive_ns_);
  (void)stream.anchor.add(sender_ns, receive_ns_);
  stream.anchored = true;
  sample.set_stamp_ns(stream.anchor.to_host_ns(stream.anchor.device_unwrapped_ns()));
  sample.imu.timing.clock_ahead_ns = sample.wheel.timing.clock_ahead_ns =
      sample.pressure.timing.clock_ahead_ns = stream.anchor.device_ahead_ns();
}

SampleInputStatus SampleInput::status() const noexcept {
  SampleInputStatus status = status_;
  status.counters = parser_.counters();
  status.base = base_.status();
  for (std::size_t kind = 0; kind < streams_.size(); ++kind) {
    status.clock_steps += streams_[kind].anchor.steps();
    status.senders[kind] = streams_[kind].sender.status();
  }
  return status;
}

}  // namespace isobar
