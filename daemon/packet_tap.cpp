// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_tap.hpp"

namespace isobar {

PacketTap::PacketTap() : publisher_(ipc::topics::kLidarPackets) {}

PacketTap::~PacketTap() { publish(); }

void PacketTap::add(const ReceivedDatagram& datagram, ipc::LidarPort port) noexcept {
  added_ = true;
  if (group_ == nullptr && !publisher_.has_subscribers()) return;
  if (group_ != nullptr && !group_->has_room(datagram.payload.size())) publish();
  if (group_ == nullptr) begin_group();
  ++offered_;
  if (group_ == nullptr) return;
  if (!group_->has_room(datagram.payload.size())) {  // longer than an empty group
    publisher_.discard(group_);
    group_ = nullptr;
    return;
  }
  group_->add(datagram.stamp_ns, datagram.sender.ipv4, port, datagram.payload);
  const bool is_full = group_->count == ipc::LidarPackets::kMaxPackets;
  if (is_full || datagram.stamp_ns - group_->packets[0].stamp_ns >= kMaxAgeNs) publish();
}

void PacketTap::end_round() noexcept {
  if (!added_) publish();
  added_ = false;
}

void PacketTap::begin_group() noexcept {
  group_ = publisher_.loan();
  if (group_ != nullptr) group_->first_number = offered_;
}

void PacketTap::publish() noexcept {
  if (group_ != nullptr) publisher_.publish(group_);
  group_ = nullptr;
}

}  // namespace isobar
