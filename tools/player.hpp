// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/datagram/datagram.hpp"
#include "drivers/udp/udp.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar::tools {

/// UDP ports that the lidar's packets are sent to.
struct LidarPlan {
  std::uint16_t port = 0;                ///< of its data
  std::uint16_t info_port = 0;           ///< of its other packets; 0: there are none
  std::uint16_t recorded_info_port = 0;  ///< that they have in the recording
};

/// Sends a recording in real time: lidar packets to the lidar ports, all other samples as datagrams
/// (drivers/datagram/datagram.hpp) to the input port.
class Player {
 public:
  /// @param address IPv4 address of the machine on which isobard runs
  /// @throws ServiceError when a socket cannot be opened
  Player(const std::string& address, const LidarPlan& lidar, std::uint16_t input_port);

  /// Maps the recording's time to the robot clock: the first event, with this stamp, is due in 200 ms. The
  /// pause lets the first samples of all streams go out in order.
  /// @return offset that is added to all stamps [ns]
  std::int64_t start(std::int64_t first_stamp_ns);
  /// Sleeps until the event is due, then sends it.
  /// @return time of sending on the robot clock [ns]
  std::int64_t send_when_due(const recording::Event& event);

 private:
  void send(const recording::Event& event);

  UdpSender lidar_;
  std::optional<UdpSender> information_;
  std::uint16_t recorded_info_port_;
  UdpSender samples_;
  std::array<std::uint32_t, datagram::kKinds> sequence_{};
  std::chrono::steady_clock::time_point started_;
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t shift_ns_ = 0;
};

}  // namespace isobar::tools
