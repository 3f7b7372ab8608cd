// SPDX-License-Identifier: BSD-3-Clause
// Segment: one append-only file of tiles and its index (tile_record.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "run/tile_store/file_descriptor.hpp"
#include "run/tile_store/tile_record.hpp"

namespace isobar {

/// Position of a tile in a segment.
struct TilePlace {
  std::uint32_t offset = 0;  ///< of the record's head [bytes]
  std::uint32_t length = 0;  ///< of the tile, without head and padding [bytes]
};

/// Result of opening a segment.
struct SegmentContent {
  struct Tile {
    TileKey key;
    TilePlace place;
  };
  std::vector<Tile> tiles;    ///< in the order of their records
  std::uint64_t torn = 0;     ///< incomplete records at the end of the file
  std::uint64_t damaged = 0;  ///< stretches without a readable record
  std::string first_fault;    ///< file, offset and rule of the first of these; empty if there was none
};

/// Append-only file of records with its index. One thread.
class TileSegment {
 public:
  enum class Access : std::uint8_t {
    kRead,   ///< changes no file
    kWrite,  ///< truncates torn records, rebuilds a faulty index
  };

  /// Opens `tiles_file` (NNNNNNNN.tiles) and the index beside it, and fills `content`. With kWrite, missing
  /// files are created.
  /// @throws ServiceError when the file of tiles cannot be opened, read or truncated
  TileSegment(std::filesystem::path tiles_file, Access access, SegmentContent& content);

  /// Appends a record. If the disk refuses, returns false, leaves the file unchanged and sets refusal().
  bool append(const TileKey& key, std::span<const std::byte> bytes, TilePlace& place);

  /// Reads and checks a tile. Returns null on success; otherwise the rule that is broken, with `bytes` empty.
  const char* read(const TileKey& key, const TilePlace& place, std::vector<std::byte>& bytes) const;

  /// Closes the index: no record is appended after this.
  void seal() { index_ = FileDescriptor(); }
  /// A second descriptor of the file of tiles, for a thread that waits for the disk; none when the system
  /// refuses.
  [[nodiscard]] FileDescriptor duplicate() const;
  /// Waits until all records are on the disk (fdatasync). False if the disk refuses.
  bool flush() noexcept;
  /// Deletes both files; tiles remain readable during the lifetime of this object.
  void remove() noexcept;

  [[nodiscard]] const std::filesystem::path& file() const { return tiles_file_; }
  /// Size of the file of tiles.
  [[nodiscard]] std::uint64_t tile_bytes() const { return end_; }
  /// Size of both files.
  [[nodiscard]] std::uint64_t disk_bytes() const { return end_ + index_end_; }
  /// Reason of the last failed append().
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
  std::uint64_t read_index(SegmentContent& content);
  void scan(std::uint64_t begin, std::uint64_t end, SegmentContent& content);
  [[nodiscard]] bool read_head(std::uint64_t offset, RecordHead& head) const;
  [[nodiscard]] std::uint64_t next_valid_head(std::uint64_t begin, std::uint64_t end) const;
  void note(SegmentContent& content, std::uint64_t offset, const char* rule) const;
  void repair(const SegmentContent& content);
  bool write_all(const FileDescriptor& file, std::span<const std::byte> bytes, std::uint64_t offset);

  std::filesystem::path tiles_file_;
  FileDescriptor tiles_;
  FileDescriptor index_;
  std::uint64_t end_ = 0;          ///< of the complete records in the file of tiles
  std::uint64_t index_end_ = 0;    ///< of the valid entries in the index
  std::uint64_t write_begun_ = 0;  ///< write-back to the disk has been started up to this offset
  bool index_is_whole_ = true;     ///< the index has an entry for every record and nothing else
  std::string refusal_;
  std::vector<std::byte> record_;  ///< scratch
};

}  // namespace isobar
