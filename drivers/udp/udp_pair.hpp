// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/udp/udp.hpp"

namespace isobar {

/// Receiver on the two ports of a lidar, waited for together: a packet of the second port neither waits for one of
/// the first nor costs anything while there is none. See UdpReceiver for what a port that is not there yet means.
class UdpPair {
 public:
  using Status = UdpReceiver::Status;

  /// @param second_port 0: there is none
  /// @throws ServiceError when the address is no IPv4 address, or this user may not use a port
  UdpPair(const std::string& address, std::uint16_t port, std::uint16_t second_port);

  /// Waits for a datagram of either port, at most timeout_ms (-1: no limit); where both have some, they take turns.
  /// Its bytes stay valid until the next call. Allocates nothing. One thread at a time.
  Status receive(ReceivedDatagram& datagram, int timeout_ms) noexcept;
  /// Sleeps while datagrams queue in the sockets; stop() ends it early. Same thread as receive().
  void pause(int duration_ms) noexcept { first_.pause(duration_ms); }
  /// Makes the current and all later receive() return kStopped. Any thread; async-signal-safe.
  void stop() noexcept { first_.stop(); }

  [[nodiscard]] const UdpReceiver& first() const noexcept { return first_; }
  /// Null: there is no second port.
  [[nodiscard]] const UdpReceiver* second() const noexcept { return second_ ? &*second_ : nullptr; }
  /// Datagrams that the kernel dropped, of both ports.
  [[nodiscard]] std::uint64_t dropped_by_kernel() const noexcept {
    return first_.dropped_by_kernel() + (second_ ? second_->dropped_by_kernel() : 0);
  }

 private:
  UdpReceiver first_;
  std::optional<UdpReceiver> second_;
  bool was_second_ = false;  ///< the last datagram's port
};

}  // namespace isobar
