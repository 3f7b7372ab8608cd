// SPDX-License-Identifier: BSD-3-Clause
// How a tile lies in a file. Numbers are little-endian, as the machine holds them.
//   NNNNNNNN.tiles  records one behind the other, each at a multiple of 8 bytes: head, bytes of the tile,
//   zeros NNNNNNNN.index  one entry a record, in the same order: what an opening reads instead of all the
//   heads
// Both only ever grow. A head is checked by its own checksum and vouches with a second one for the bytes
// behind it; an index that is missing, damaged or too short is made again from the heads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/map/tile_key.hpp"

namespace isobar {

/// Bytes of a tile at most: a guard against a damaged length. The map's tiles have 1 to 500 kB.
inline constexpr std::size_t kMaxTileBytes = std::size_t{1} << 26;
/// Records begin at multiples of this.
inline constexpr std::size_t kRecordAlignment = 8;

/// In front of a tile's bytes.
struct RecordHead {
  static constexpr std::uint32_t kMagic = 0x454C4954;  ///< "TILE"
  std::uint32_t magic = kMagic;
  std::uint32_t length = 0;  ///< bytes of the tile, without the zeros behind them
  TileKey key;
  std::uint32_t bytes_crc = 0;
  std::uint32_t reserved = 0;
  std::uint32_t head_crc = 0;  ///< of everything above
};
static_assert(sizeof(RecordHead) == 32 && alignof(RecordHead) <= kRecordAlignment);

/// One line of an index.
struct IndexEntry {
  TileKey key;
  std::uint32_t offset = 0;  ///< of the head in the file of tiles
  std::uint32_t length = 0;  ///< as in the head
  std::uint32_t crc = 0;     ///< of everything above
};
static_assert(sizeof(IndexEntry) == 24);

/// CRC-32 as zlib computes it.
[[nodiscard]] std::uint32_t checksum(std::span<const std::byte> bytes);

/// Bytes of a record: head, tile, zeros.
[[nodiscard]] constexpr std::uint64_t record_bytes(std::size_t length) {
  return sizeof(RecordHead) +
         (std::uint64_t{length} + kRecordAlignment - 1) / kRecordAlignment * kRecordAlignment;
}

[[nodiscard]] RecordHead make_head(const TileKey& key, std::span<const std::byte> bytes);
[[nodiscard]] IndexEntry make_entry(const TileKey& key, std::uint32_t offset, std::uint32_t length);

/// True if nobody has changed a bit of it and its length is one that a tile can have.
[[nodiscard]] bool is_sound(const RecordHead& head);
[[nodiscard]] bool is_sound(const IndexEntry& entry);

/// For hash tables of tiles.
struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const { return key.hash(); }
};

}  // namespace isobar
