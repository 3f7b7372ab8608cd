// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

#include "daemon/worker_watch.hpp"
#include "drivers/datagram/udp.hpp"

namespace isobar {

/// The life of a thread that lives on datagrams: `take(datagram)` for each of them, `report()` after each and
/// five times a second without, each time with a sign of life. Returns once the receiver was stopped. Neither
/// may throw.
template <class Take, class Report>
void receive_until_stopped(UdpReceiver& receiver, Heartbeat& heartbeat, const Take& take,
                           const Report& report) noexcept {
  constexpr int kReportEveryMs = 200;
  // A socket that fails at once, again and again, must not keep a core from threads of lower priority.
  constexpr timespec kAfterError{0, 10'000'000};
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
        nanosleep(&kAfterError, nullptr);
        break;
    }
    report();
  }
}

}  // namespace isobar
