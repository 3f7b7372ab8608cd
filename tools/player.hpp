// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

#include "drivers/datagram/datagram.hpp"
#include "drivers/datagram/udp.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar::tools {

/// Sends a recording as its sensors did: lidar packets to the lidar's port, all other samples as datagrams
/// (drivers/datagram/datagram.hpp) to the input port, each at its time.
class Player {
 public:
  /// @param address IPv4 address of the machine on which isobard runs
  /// @throws ServiceError see UdpSender
  Player(const std::string& address, std::uint16_t lidar_port, std::uint16_t input_port);

  /// Ties the recording's time to the robot clock: its first event, of this stamp, is due in 200 ms, a moment
  /// for the first samples of all streams to be due in order. Returns what is added to stamps.
  std::int64_t start(std::int64_t first_stamp_ns);
  /// Sleeps until the event is due, then sends it. Returns when that was, robot clock.
  std::int64_t send_when_due(const recording::Event& event);

 private:
  void send(const recording::Event& event);

  UdpSender lidar_;
  UdpSender samples_;
  std::array<std::uint32_t, datagram::kKinds> sequence_{};
  std::chrono::steady_clock::time_point started_;
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t shift_ns_ = 0;
};

}  // namespace isobar::tools
