// SPDX-License-Identifier: BSD-3-Clause
// Parsing and validation of a data packet.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/velodyne/packet_format.hpp"

namespace isobar::velodyne {

/// All integers of the packet are little-endian.
inline std::uint32_t read_u16(const std::uint8_t* at) {
  return at[0] | static_cast<std::uint32_t>(at[1]) << 8U;
}

enum class DecodeStatus : std::uint8_t {
  kOk,          ///< decoded
  kPosition,    ///< a valid position packet; it has no points
  kTruncated,   ///< shorter than a data packet
  kOversized,   ///< longer than a data packet
  kGarbage,     ///< right size, but a block flag, an azimuth or the return mode is invalid
  kWrongModel,  ///< from another model than configured: see VelodyneDecoder::wrong_model_message()
  kDuplicate,   ///< received before
  kTooLate,     ///< reordered too late for the open scan
};

/// Header fields of a valid packet, and a pointer to its returns.
struct DataPacket {
  const std::uint8_t* bytes = nullptr;  ///< kDataPacketBytes, owned by the caller
  std::uint32_t timestamp_us = 0;       ///< past the hour, of the first firing
  std::uint8_t product_id = 0;
  bool dual = false;
  std::array<std::uint32_t, kBlocks> azimuth{};  ///< by block [0.01 deg], below kFullTurn
  std::int64_t device_ns = 0;                    ///< unwrapped time of the first firing; set by the decoder

  /// The 32 channels of a block.
  [[nodiscard]] const std::uint8_t* channels(int block) const {
    return bytes + static_cast<std::size_t>(block) * kBlockBytes + kBlockHeaderBytes;
  }
};

/// Parses and validates a UDP payload.
/// @param packet filled with kOk; with kWrongModel only its product_id is valid
/// @return kOk, kPosition, kTruncated, kOversized, kGarbage or kWrongModel
DecodeStatus read_packet(std::span<const std::uint8_t> payload, Model model, DataPacket& packet);

}  // namespace isobar::velodyne
