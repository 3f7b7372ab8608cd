// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sample_thread.hpp"

#include "daemon/receive_loop.hpp"

namespace isobar {

SampleThread::SampleThread(const std::string& address, std::uint16_t port, Takes takes,
                           ThreadSettings settings)
    : takes_(takes),
      receiver_(address, port),
      imu_(ipc::topics::kImu),
      barometer_(ipc::topics::kBarometer),
      base_barometer_(ipc::topics::kBaseBarometer),
      wheel_(ipc::topics::kWheel),
      worker_(std::move(settings), receiver_, [this] { loop(); }) {}

void SampleThread::loop() noexcept {
  receive_until_stopped(
      receiver_, worker_.heartbeat(), [this](const ReceivedDatagram& datagram) { take_datagram(datagram); },
      [this] { report(); });
}

void SampleThread::take_datagram(const ReceivedDatagram& received) noexcept {
  parser_.begin(received.payload);
  datagram::Sample sample;
  while (parser_.next(sample)) {
    const bool is_barometer = sample.kind == datagram::Kind::kPressure;
    if (!(is_barometer ? takes_.barometer : takes_.others)) {
      ++(is_barometer ? draft_status_.refused_pressure : draft_status_.not_of_this_role);
      continue;
    }
    if (to_robot_clock(sample, received) && !publish(sample)) ++draft_status_.samples_without_memory;
  }
}

// False for a base-station sample that BaseStationStream refuses (old, repeated, another sender).
bool SampleThread::to_robot_clock(datagram::Sample& sample, const ReceivedDatagram& received) noexcept {
  const bool stamped = sample.stamp_ns() != 0;
  if (!stamped) sample.set_stamp_ns(received.stamp_ns);
  if (sample.kind == datagram::Kind::kBasePressure) {
    return base_.check(received.sender_ipv4, sample.pressure, received.stamp_ns) == BaseVerdict::kAccepted;
  }
  if (!stamped) return true;
  ClockAnchor& anchor = anchors_[static_cast<std::size_t>(sample.kind)];
  (void)anchor.add(sample.stamp_ns(), received.stamp_ns);
  sample.set_stamp_ns(anchor.to_host_ns(anchor.device_unwrapped_ns()));
  return true;
}

bool SampleThread::publish(const datagram::Sample& sample) noexcept {
  switch (sample.kind) {
    case datagram::Kind::kImu:
      return imu_.send(sample.imu);
    case datagram::Kind::kPressure:
      return barometer_.send(sample.pressure);
    case datagram::Kind::kBasePressure:
      return base_barometer_.send(sample.pressure);
    case datagram::Kind::kWheel:
      return wheel_.send(sample.wheel);
  }
  return true;
}

void SampleThread::report() noexcept {
  draft_status_.counters = parser_.counters();
  draft_status_.dropped_by_kernel = receiver_.dropped_by_kernel();
  draft_status_.clock_steps = 0;
  for (const ClockAnchor& anchor : anchors_) draft_status_.clock_steps += anchor.steps();
  draft_status_.base = base_.status();
  status_.put(draft_status_);
}

}  // namespace isobar
