// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_tap.hpp"

#include <algorithm>

namespace isobar {

PacketTap::PacketTap() : publisher_(ipc::topics::kLidarPackets) {}

PacketTap::~PacketTap() {
  if (group_ != nullptr) publish();
}

void PacketTap::add(const ReceivedDatagram& datagram) noexcept {
  added_ = true;
  if (group_ == nullptr) {
    if (!publisher_.has_subscribers()) return;
    group_ = publisher_.loan();
  }
  if (group_ == nullptr || datagram.payload.size() > ipc::LidarPacket::kMaxBytes) {
    ++lost_;
    return;
  }
  ipc::LidarPacket& packet = group_->packets[group_->count++];
  packet.stamp_ns = datagram.stamp_ns;
  packet.sender_ipv4 = datagram.sender.ipv4;
  packet.byte_count = static_cast<std::uint32_t>(datagram.payload.size());
  std::copy(datagram.payload.begin(), datagram.payload.end(), packet.bytes);
  if (group_->count == ipc::LidarPackets::kMaxPackets) publish();
}

void PacketTap::end_round() noexcept {
  if (!added_ && group_ != nullptr) publish();
  added_ = false;
}

void PacketTap::publish() noexcept {
  group_->lost = lost_;
  publisher_.publish(group_);
  group_ = nullptr;
}

}  // namespace isobar
