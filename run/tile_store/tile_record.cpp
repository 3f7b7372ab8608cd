// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/tile_record.hpp"

#include <zlib.h>

#include <bit>

namespace isobar {

static_assert(std::endian::native == std::endian::little, "records are written as they are in memory");

namespace {

bool is_tile_length(std::uint32_t length) { return length > 0 && length <= kMaxTileBytes; }

/// Checksum of all fields but the last, which holds the checksum itself.
template <typename Record>
std::uint32_t crc_of_fields(const Record& record) {
  return crc32_of(std::as_bytes(std::span(&record, 1)).first(sizeof(Record) - sizeof(std::uint32_t)));
}

}  // namespace

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));  // NOLINT: zlib's type
}

RecordHead RecordHead::of(const TileKey& key, std::span<const std::byte> bytes) {
  RecordHead head;
  head.length = static_cast<std::uint32_t>(bytes.size());
  head.key = key;
  head.bytes_crc = crc32_of(bytes);
  head.head_crc = crc_of_fields(head);
  return head;
}

IndexEntry IndexEntry::of(const TileKey& key, std::uint32_t offset, std::uint32_t length) {
  IndexEntry entry{key, offset, length, 0};
  entry.crc = crc_of_fields(entry);
  return entry;
}

bool RecordHead::is_valid() const {
  return magic == kMagic && is_tile_length(length) && head_crc == crc_of_fields(*this);
}

bool IndexEntry::is_valid() const {
  return is_tile_length(length) && offset % kRecordAlignment == 0 && crc == crc_of_fields(*this);
}

}  // namespace isobar
