// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/udp/udp.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Publishes the lidar's datagrams for recorders, in groups; without a subscriber it copies nothing. Belongs
/// to the lidar thread. Allocates nothing after construction.
class PacketTap {
 public:
  PacketTap();
  ~PacketTap();
  PacketTap(const PacketTap&) = delete;
  PacketTap& operator=(const PacketTap&) = delete;

  /// Copies a datagram into the current group; publishes the group when it is full. A datagram longer than
  /// ipc::LidarPacket::kMaxBytes, or one for which shared memory is exhausted, is counted as lost.
  void add(const ReceivedDatagram& datagram) noexcept;
  /// Call after each wait for a datagram: a round without one publishes the current group, so that silence
  /// holds nothing back.
  void end_round() noexcept;

 private:
  void publish() noexcept;

  ipc::Publisher<ipc::LidarPackets> publisher_;
  ipc::LidarPackets* group_ = nullptr;  ///< on loan, not yet full
  bool added_ = false;                  ///< in this round
  std::uint64_t lost_ = 0;
};

}  // namespace isobar
