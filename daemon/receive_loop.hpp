// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

#include "daemon/worker.hpp"
#include "drivers/udp/udp.hpp"

namespace isobar {

/// Loop of a thread that receives datagrams from a UdpReceiver or a UdpPair: `take(datagram)` for each datagram; a beat
/// and `report()` after each datagram and every 200 ms without one. Returns after the receiver was stopped. Neither
/// may throw.
template <class Receiver, class Take, class Report>
void receive_until_stopped(Receiver& receiver, Heartbeat& heartbeat, const Take& take,
                           const Report& report) noexcept {
  constexpr int kReportEveryMs = 200;
  // Pause of 10 ms: a socket that fails at once, repeatedly,
  // must not keep a core from threads of lower priority.
  constexpr timespec kPauseAfterError{0, 10'000'000};
  ReceivedDatagram datagram;
  for (;;) {
    heartbeat.beat();
    switch (receiver.receive(datagram, kReportEveryMs)) {
      case UdpReceiver::Status::kDatagram:
        take(datagram);
        break;
      case UdpReceiver::Status::kStopped:
        report();
        return;
      case UdpReceiver::Status::kTimeout:
        break;
      case UdpReceiver::Status::kError:
        nanosleep(&kPauseAfterError, nullptr);
        break;
    }
    report();
  }
}

}  // namespace isobar
