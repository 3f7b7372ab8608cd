// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/velodyne/data_packet.hpp"

namespace isobar::velodyne {

DecodeStatus read_packet(std::span<const std::uint8_t> payload, DataPacket& packet) {
  if (payload.size() == kPositionPacketBytes) {
    return DecodeStatus::kNoPoints;
  }
  if (payload.size() != kDataPacketBytes) {
    return payload.size() < kDataPacketBytes ? DecodeStatus::kTruncated : DecodeStatus::kOversized;
  }
  packet.bytes = payload.data();
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::uint8_t* at = packet.bytes + block * kBlockBytes;
    packet.azimuth[block] = le16(at + 2);
    if (at[0] != kBlockFlag0 || at[1] != kBlockFlag1 || packet.azimuth[block] >= kFullTurn) {
      return DecodeStatus::kGarbage;
    }
  }
  packet.product_id = packet.bytes[kProductIdOffset];
  const auto mode = static_cast<ReturnMode>(packet.bytes[kReturnModeOffset]);
  if (mode != ReturnMode::kStrongest && mode != ReturnMode::kLast && mode != ReturnMode::kDual) {
    return DecodeStatus::kGarbage;
  }
  packet.dual = mode == ReturnMode::kDual;
  const std::uint8_t* time = packet.bytes + kTimestampOffset;
  packet.timestamp_us = le32(time);
  return DecodeStatus::kOk;
}

}  // namespace isobar::velodyne
