// SPDX-License-Identifier: BSD-3-Clause
// Parsing and validation of a data packet.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/velodyne/packet_format.hpp"

namespace isobar::velodyne {

/// Header fields of a valid packet, and a pointer to its returns.
struct DataPacket {
  const std::uint8_t* bytes = nullptr;  ///< kDataPacketBytes, owned by the caller
  std::uint32_t timestamp_us = 0;       ///< past the hour, of the first firing
  std::uint8_t product_id = 0;
  bool dual = false;
  std::array<std::uint32_t, kBlocks> azimuth{};  ///< by block [0.01 deg], below kFullTurn

  /// The 32 channels of a block.
  [[nodiscard]] const std::uint8_t* channels(int block) const {
    return bytes + static_cast<std::size_t>(block) * kBlockBytes + kBlockHeaderBytes;
  }
};

/// Parses and validates a UDP payload, of any model.
/// @param packet filled with kOk
/// @return kOk, kNoPoints (a position packet), kTruncated, kOversized or kGarbage
DecodeStatus read_packet(std::span<const std::uint8_t> payload, DataPacket& packet);

}  // namespace isobar::velodyne
