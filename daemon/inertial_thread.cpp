// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/inertial_thread.hpp"

#include "daemon/receive_loop.hpp"

namespace isobar {

InertialThread::InertialThread(const std::string& address, std::uint16_t port, Takes takes,
                               ThreadSettings settings)
    : settings_(std::move(settings)),
      takes_(takes),
      receiver_(address, port),
      imu_(ipc::topics::kImu),
      barometer_(ipc::topics::kBarometer),
      base_barometer_(ipc::topics::kBaseBarometer),
      wheel_(ipc::topics::kWheel) {}

InertialThread::~InertialThread() { stop(); }

void InertialThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void InertialThread::stop() noexcept {
  receiver_.stop();
  if (thread_.joinable()) thread_.join();
}

void InertialThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  receive_until_stopped(
      receiver_, heartbeat_, [this](const ReceivedDatagram& datagram) { take_datagram(datagram); },
      [this] { report(); });
}

void InertialThread::take_datagram(const ReceivedDatagram& received) noexcept {
  parser_.begin(received.payload);
  datagram::Sample sample;
  while (parser_.next(sample)) {
    const bool is_barometer = sample.kind == datagram::Kind::kPressure;
    if (!(is_barometer ? takes_.barometer : takes_.others)) {
      ++(is_barometer ? own_.refused_pressure : own_.not_of_this_role);
      continue;
    }
    if (to_robot_clock(sample, received) && !publish(sample)) ++own_.samples_without_memory;
  }
}

// False for a sample of a base station that is not of now.
bool InertialThread::to_robot_clock(datagram::Sample& sample, const ReceivedDatagram& received) noexcept {
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

bool InertialThread::publish(const datagram::Sample& sample) noexcept {
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

void InertialThread::report() noexcept {
  own_.counters = parser_.counters();
  own_.dropped_by_kernel = receiver_.dropped_by_kernel();
  own_.clock_steps = 0;
  for (const ClockAnchor& anchor : anchors_) own_.clock_steps += anchor.steps();
  own_.base = base_.status();
  status_.put(own_);
}

}  // namespace isobar
