// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/udp/udp_pair.hpp"

#include <poll.h>

#include <array>
#include <cerrno>

namespace isobar {

UdpPair::UdpPair(const std::string& address, std::uint16_t port, std::uint16_t second_port)
    : first_(address, port) {
  if (second_port != 0) second_.emplace(address, second_port);
}

UdpPair::Status UdpPair::receive(ReceivedDatagram& datagram, int timeout_ms) noexcept {
  int wait_ms = first_.prepare(timeout_ms);
  if (second_) wait_ms = second_->prepare(wait_ms);
  // poll() skips a descriptor below 0.
  std::array<pollfd, 3> waits{pollfd{first_.socket_, POLLIN, 0}, pollfd{first_.stop_event_, POLLIN, 0},
                              pollfd{second_ ? second_->socket_ : -1, POLLIN, 0}};
  const int ready = poll(waits.data(), waits.size(), wait_ms);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return Status::kTimeout;
  if (ready < 0) return Status::kError;
  if (waits[1].revents != 0) return Status::kStopped;
  was_second_ = waits[2].revents != 0 && (waits[0].revents == 0 || !was_second_);
  const Status status = (was_second_ ? *second_ : first_).read(datagram);
  datagram.second = was_second_;
  return status;
}

}  // namespace isobar
