// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/input_tap.hpp"

#include <algorithm>

namespace isobar {

void InputTap::drain_packets(recording::InputLog& log) {
  while (const auto group = packets_.take()) {
    const auto count = std::min(group->count, ipc::LidarPackets::kMaxPackets);
    for (std::uint32_t i = 0; i < count; ++i) {
      const ipc::LidarPacket& packet = group->packets[i];
      const auto bytes = std::min<std::size_t>(packet.byte_count, ipc::LidarPacket::kMaxBytes);
      (void)log.add_packet(packet.stamp_ns, packet.sender_ipv4, {packet.bytes, bytes});
    }
    if (!lost_before_) lost_before_ = group->lost;
    lost_packets_ = group->lost - *lost_before_;
  }
}

void InputTap::drain_base_stations(recording::InputLog& log) {
  while (const auto sample = base_barometer_.take()) {
    const bool is_known = sample->station < base_paths_.size();
    if (is_known && base_paths_[sample->station].check(*sample)) log.add_base_pressure(*sample);
  }
}

void InputTap::drain(recording::InputLog& log) {
  while (const auto sample = imu_.take()) {
    if (imu_path_.check(*sample)) log.add(*sample);
  }
  while (const auto sample = barometer_.take()) log.add_pressure(*sample);
  drain_base_stations(log);
  while (const auto sample = wheel_.take()) {
    if (wheel_path_.check(*sample)) log.add(*sample);
  }
  drain_packets(log);
}

std::uint64_t InputTap::lost() const noexcept {
  // A dropped group of packets counts as a full one: all are, but the last one before a silence.
  return packets_.dropped() * ipc::LidarPackets::kMaxPackets + imu_.dropped() + barometer_.dropped() +
         base_barometer_.dropped() + wheel_.dropped() + lost_packets_;
}

}  // namespace isobar
