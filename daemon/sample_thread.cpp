// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sample_thread.hpp"

#include "daemon/receive_loop.hpp"

namespace isobar {

SampleThread::SampleThread(const std::string& address, std::uint16_t port, SampleInput::Takes takes,
                           const std::string& senders, ThreadSettings settings)
    : receiver_(address, port),
      input_(takes, addresses_of(senders)),
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
  input_.begin(received, receiver_.clock().system());
  datagram::Sample sample;
  while (input_.next(sample)) {
    if (!publish(sample)) ++draft_status_.samples_without_memory;
  }
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
  static_cast<SampleInputStatus&>(draft_status_) = input_.status();
  draft_status_.dropped_by_kernel = receiver_.dropped_by_kernel();
  status_.put(draft_status_);
}

}  // namespace isobar
