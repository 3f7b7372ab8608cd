// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/input_tap.hpp"

namespace isobar {

void InputTap::drain_packets(recording::InputLog& log) {
  while (const auto group = packets_.take()) {
    const auto packets = group->valid_packets();
    if (next_packet_ && group->first_number > *next_packet_) {
      lost_packets_ += group->first_number - *next_packet_;
    }
    next_packet_ = group->first_number + packets.size();
    for (const ipc::LidarPacket& packet : packets) {
      const bool is_added =
          packet.port == ipc::LidarPort::kInformation
              ? log.add_information(packet.stamp_ns, packet.sender_ipv4, group->payload(packet))
              : log.add_packet(packet.stamp_ns, packet.sender_ipv4, group->payload(packet));
      lost_packets_ += is_added ? 0 : 1;
    }
  }
}

void InputTap::drain_base_stations(recording::InputLog& log) {
  while (const auto sample = base_barometer_.take()) {
    const bool is_known = sample->station < base_paths_.size();
    if (is_known && base_paths_[sample->station].check(*sample)) log.add_base_pressure(*sample);
  }
}

void InputTap::take_scans(bool wanted) {
  if (!wanted) scans_.reset();
  if (wanted && !scans_) scans_.emplace(ipc::topics::kLidarScan);
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
  while (scans_) {
    const auto scan = scans_->take();
    if (!scan) break;
    log.add_scan(*scan);
  }
}

std::uint64_t InputTap::lost() const noexcept {
  return lost_packets_ + imu_.dropped() + barometer_.dropped() + base_barometer_.dropped() +
         wheel_.dropped() + (scans_ ? scans_->dropped() : 0);
}

}  // namespace isobar
