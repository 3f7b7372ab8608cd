// SPDX-License-Identifier: BSD-3-Clause
// Format of the files of a map. Little-endian.
//
//   NNNNNNNN.tiles  segment: consecutive records, each a RecordHead, the bytes of the tile, and zeros up to a
//                   multiple of 8
//   NNNNNNNN.index  one IndexEntry per record, in the same order; read on opening instead of all heads
//
// Both files are append-only. A head contains a checksum of itself and one of the tile's bytes. An index that
// is missing, damaged or too short is rebuilt from the heads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/map/tile_key.hpp"

namespace isobar {

/// Maximum size of a tile, a plausibility check of lengths read from disk. Tiles of the map are 1 … 500 kB.
inline constexpr std::size_t kMaxTileBytes = std::size_t{1} << 26;
/// Alignment of records in a file [bytes]: heads are searched at its multiples after damage.
inline constexpr std::size_t kRecordAlignment = 8;

/// CRC-32 (zlib's polynomial).
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::byte> bytes);

/// Head of a record, in front of the tile's bytes.
struct RecordHead {
  static constexpr std::uint32_t kMagic = 0x454C4954;  ///< "TILE"
  std::uint32_t magic = kMagic;
  std::uint32_t length = 0;  ///< bytes of the tile, without the padding
  TileKey key;
  std::uint32_t bytes_crc = 0;  ///< of the tile's bytes
  std::uint32_t reserved = 0;
  std::uint32_t head_crc = 0;  ///< of all fields above

  [[nodiscard]] static RecordHead of(const TileKey& key, std::span<const std::byte> bytes);
  /// True if magic number, checksum and range of the length are right.
  [[nodiscard]] bool is_valid() const;
};
static_assert(sizeof(RecordHead) == 32 && alignof(RecordHead) <= kRecordAlignment);

/// Entry of an index.
struct IndexEntry {
  TileKey key;
  std::uint32_t offset = 0;  ///< of the record's head in the segment [bytes]
  std::uint32_t length = 0;  ///< as in the head
  std::uint32_t crc = 0;     ///< of all fields above

  [[nodiscard]] static IndexEntry of(const TileKey& key, std::uint32_t offset, std::uint32_t length);
  /// True if checksum, alignment of the offset and range of the length are right.
  [[nodiscard]] bool is_valid() const;
};
static_assert(sizeof(IndexEntry) == 24);

/// Size of the record of a tile of `length` bytes, including head and padding.
[[nodiscard]] constexpr std::uint64_t record_bytes(std::size_t length) {
  return sizeof(RecordHead) +
         (std::uint64_t{length} + kRecordAlignment - 1) / kRecordAlignment * kRecordAlignment;
}

}  // namespace isobar
