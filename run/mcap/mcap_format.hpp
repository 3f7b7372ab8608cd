// SPDX-License-Identifier: BSD-3-Clause
// Constants of the MCAP format (mcap.dev/spec, version 0), for its writer and its reader.
#pragma once

#include <cstdint>
#include <string_view>

namespace isobar::mcap {

/// First and last bytes of a file.
inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

/// Kinds of records.
namespace opcode {
inline constexpr std::uint8_t kHeader = 0x01;
inline constexpr std::uint8_t kFooter = 0x02;
inline constexpr std::uint8_t kSchema = 0x03;
inline constexpr std::uint8_t kChannel = 0x04;
inline constexpr std::uint8_t kMessage = 0x05;
inline constexpr std::uint8_t kChunk = 0x06;
inline constexpr std::uint8_t kMessageIndex = 0x07;
inline constexpr std::uint8_t kChunkIndex = 0x08;
inline constexpr std::uint8_t kStatistics = 0x0B;
inline constexpr std::uint8_t kSummaryOffset = 0x0E;
inline constexpr std::uint8_t kDataEnd = 0x0F;
}  // namespace opcode

}  // namespace isobar::mcap
