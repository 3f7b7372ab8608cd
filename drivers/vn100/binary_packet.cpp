// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/binary_packet.hpp"

#include <array>

namespace isobar::vn100 {

namespace {

constexpr int kGroups = 7;
constexpr int kFields = 15;
constexpr std::uint8_t kMoreGroups = 0x80;
constexpr std::uint16_t kMoreFields = 0x8000;
constexpr std::size_t kCrcBytes = 2;

/// Lengths of the fields [bytes] by group and bit (UM001 v2.22 section 4.4; groups 4, 6 and 7, which a VN-100
/// does not have, from the manual of the VN-300). 0: reserved, or of variable length (satellite lists).
constexpr std::array<std::array<std::uint8_t, kFields>, kGroups> kFieldBytes{{
    {8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8},     // common
    {8, 8, 8, 2, 8, 8, 8, 4, 4, 1, 0, 0, 0, 0, 0},              // time
    {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 40, 0, 0},     // IMU
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0},        // GNSS 1
    {2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24, 12, 0, 0},  // attitude
    {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64, 0, 0},    // INS
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0},        // GNSS 2
}};

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}

/// Sum of the lengths of a group's fields up to `end`; false when one is unknown.
bool add_fields(int group, std::uint16_t fields, int end, std::size_t& bytes) {
  for (int bit = 0; bit < end; ++bit) {
    if ((fields >> bit & 1U) == 0) continue;
    const std::size_t length = field_bytes(group, bit);
    if (length == 0) return false;
    bytes += length;
  }
  return true;
}

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte << 8U);
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (crc & 0x8000U) != 0;
      crc = static_cast<std::uint16_t>(crc << 1U);
      if (carry) crc ^= 0x1021U;
    }
  }
  return crc;
}

std::size_t field_bytes(int group, int bit) noexcept {
  const bool exists = group >= 1 && group <= kGroups && bit >= 0 && bit < kFields;
  return exists ? kFieldBytes[static_cast<std::size_t>(group - 1)][static_cast<std::size_t>(bit)] : 0;
}

PacketSize measure_packet(std::span<const std::uint8_t> bytes) noexcept {
  PacketSize size;
  if (bytes.empty() || bytes[0] != kSync) return size;
  size.form = PacketForm::kIncomplete;
  if (bytes.size() < 2) return size;
  const std::uint8_t groups = bytes[1];
  std::size_t at = 2;
  std::size_t payload = 0;
  bool known = groups != 0 && (groups & kMoreGroups) == 0;
  for (int group = 1; known && group <= kGroups; ++group) {
    if ((groups >> (group - 1) & 1U) == 0) continue;
    if (at + 2 > bytes.size()) return size;
    const std::uint16_t fields = word_at(bytes, at);
    known = fields != 0 && (fields & kMoreFields) == 0 && add_fields(group, fields, kFields, payload);
    at += 2;
  }
  size.header_bytes = at;
  if (!known) {
    size.form = PacketForm::kNone;
    return size;
  }
  size.bytes = at + payload + kCrcBytes;
  if (bytes.size() < size.bytes) return size;
  const bool holds = crc16(bytes.subspan(1, size.bytes - 1)) == 0;
  size.form = holds ? PacketForm::kWhole : PacketForm::kCorrupt;
  return size;
}

std::span<const std::uint8_t> field(std::span<const std::uint8_t> packet, int wanted, int bit) noexcept {
  const std::uint8_t groups = packet[1];
  std::size_t word = 2;
  std::size_t before = 0;  // payload bytes before the field
  bool has = false;
  for (int group = 1; group <= kGroups; ++group) {
    if ((groups >> (group - 1) & 1U) == 0) continue;
    const std::uint16_t fields = word_at(packet, word);
    word += 2;
    if (group == wanted) has = (fields >> bit & 1U) != 0;
    if (group < wanted) add_fields(group, fields, kFields, before);
    if (group == wanted) add_fields(group, fields, bit, before);
  }
  return has ? packet.subspan(word + before, field_bytes(wanted, bit)) : std::span<const std::uint8_t>{};
}

}  // namespace isobar::vn100
