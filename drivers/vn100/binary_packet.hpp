// SPDX-License-Identifier: BSD-3-Clause
// Binary output of VectorNav sensors: sync byte 0xFA, one byte of groups, one 16-bit word of fields for each
// group, the fields, CRC. Little-endian (VN-100 User Manual UM001 v2.22, sections 4.2 and 4.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace isobar::vn100 {

inline constexpr std::uint8_t kSync = 0xFA;

/// Groups that are used here, as bits of the groups byte plus one.
enum class Group : std::uint8_t { kCommon = 1, kTime = 2, kImu = 3, kAttitude = 5 };

/// CRC-16 of UM001 section 3.3 (polynomial 0x1021, start 0, most significant bit first). Over a message with
/// its CRC it is 0.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept;

enum class PacketForm : std::uint8_t {
  kIncomplete,  ///< may become a packet with more bytes
  kWhole,       ///< header, all fields and a CRC that holds
  kCorrupt,     ///< header of a packet, all its bytes, another CRC
  kNone,        ///< no packet of a known form starts here
};

struct PacketSize {
  PacketForm form = PacketForm::kNone;
  std::size_t header_bytes = 0;  ///< sync, groups, fields
  std::size_t bytes = 0;  ///< whole packet with CRC; 0 while the header is incomplete, or of no known form
};

/// Form of what starts at the first byte. Fields of groups 1 to 7 whose length is fixed are known; a packet
/// with any other field has none; its header_bytes are those up to the group with that field.
[[nodiscard]] PacketSize measure_packet(std::span<const std::uint8_t> bytes) noexcept;

/// Bytes of a field of a whole packet; empty: the packet does not have it.
/// @param group 1 to 7
/// @param bit of the group's field word
[[nodiscard]] std::span<const std::uint8_t> field(std::span<const std::uint8_t> packet, int group,
                                                  int bit) noexcept;
[[nodiscard]] inline std::span<const std::uint8_t> field(std::span<const std::uint8_t> packet, Group group,
                                                         int bit) noexcept {
  return field(packet, static_cast<int>(group), bit);
}

/// Length of a field [bytes]; 0: unknown, or not fixed.
[[nodiscard]] std::size_t field_bytes(int group, int bit) noexcept;

}  // namespace isobar::vn100
