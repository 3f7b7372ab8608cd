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
  /// Span of a group from its first to its last datagram [ns]: what a subscriber lacks at most. A queue then holds
  /// 1.2 s of a dual-return HDL-32E, and 0.12 s of an Ouster with 1280 packets per second, two in a group.
  static constexpr std::int64_t kMaxAgeNs = 20'000'000;

  PacketTap();
  ~PacketTap();
  PacketTap(const PacketTap&) = delete;
  PacketTap& operator=(const PacketTap&) = delete;

  /// Copies a datagram into the current group; publishes the group when it is full or old. A datagram longer than
  /// ipc::LidarPackets::kMaxBytes, or one for which shared memory is exhausted, is lost: the numbers of the groups
  /// tell subscribers.
  void add(const ReceivedDatagram& datagram, ipc::LidarPort port) noexcept;
  /// Call after each wait for a datagram: a round without one publishes the current group, so that silence
  /// holds nothing back.
  void end_round() noexcept;

 private:
  void begin_group() noexcept;
  void publish() noexcept;

  ipc::Publisher<ipc::LidarPackets> publisher_;
  ipc::LidarPackets* group_ = nullptr;  ///< on loan, not yet full
  bool added_ = false;                  ///< in this round
  std::uint64_t offered_ = 0;           ///< datagrams, while there was a subscriber
};

}  // namespace isobar
