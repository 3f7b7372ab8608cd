// SPDX-License-Identifier: BSD-3-Clause
// A data packet that has been checked, field by field, before anything believes it.
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
  kPosition,    ///< a position packet: no points, nothing wrong
  kTruncated,   ///< shorter than a data packet
  kOversized,   ///< longer than a data packet
  kGarbage,     ///< right size, but a block flag, an azimuth or the return mode is impossible
  kWrongModel,  ///< of another model than configured: see VelodyneDecoder::wrong_model_message()
  kDuplicate,   ///< seen already
  kTooLate,     ///< overtaken by so much that no open scan can hold it
};

struct DataPacket {
  const std::uint8_t* bytes = nullptr;  ///< kDataPacketBytes of them, of the caller's
  std::uint32_t timestamp_us = 0;       ///< past the hour
  std::uint8_t product_id = 0;
  bool dual = false;
  std::array<std::uint32_t, kBlocks> azimuth{};  ///< by block [0.01 deg], below kFullTurn
  std::int64_t device_ns = 0;                    ///< of its first firing, unwrapped; for the caller to set

  /// The 32 channels of a block.
  [[nodiscard]] const std::uint8_t* channels(int block) const {
    return bytes + static_cast<std::size_t>(block) * kBlockBytes + kBlockHeaderBytes;
  }
};

/// Checks a UDP payload. kOk, kPosition, kTruncated, kOversized, kGarbage or kWrongModel; `packet` is filled
/// for kOk, its product_id for kWrongModel too.
DecodeStatus read_packet(std::span<const std::uint8_t> payload, Model model, DataPacket& packet);

}  // namespace isobar::velodyne
