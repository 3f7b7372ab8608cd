// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/tile_record.hpp"

#include <zlib.h>

#include <bit>

namespace isobar {

static_assert(std::endian::native == std::endian::little, "the files hold numbers as the machine does");

namespace {

bool is_tile_length(std::uint32_t length) { return length > 0 && length <= kMaxTileBytes; }

/// Of everything but the last number, which is the checksum itself.
template <typename Record>
std::uint32_t checksum_of(const Record& record) {
  return checksum(std::as_bytes(std::span(&record, 1)).first(sizeof(Record) - sizeof(std::uint32_t)));
}

}  // namespace

std::uint32_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));  // NOLINT: zlib's type
}

RecordHead make_head(const TileKey& key, std::span<const std::byte> bytes) {
  RecordHead head;
  head.length = static_cast<std::uint32_t>(bytes.size());
  head.key = key;
  head.bytes_crc = checksum(bytes);
  head.head_crc = checksum_of(head);
  return head;
}

IndexEntry make_entry(const TileKey& key, std::uint32_t offset, std::uint32_t length) {
  IndexEntry entry{key, offset, length, 0};
  entry.crc = checksum_of(entry);
  return entry;
}

bool is_sound(const RecordHead& head) {
  return head.magic == RecordHead::kMagic && is_tile_length(head.length) &&
         head.head_crc == checksum_of(head);
}

bool is_sound(const IndexEntry& entry) {
  return is_tile_length(entry.length) && entry.offset % kRecordAlignment == 0 &&
         entry.crc == checksum_of(entry);
}

}  // namespace isobar
