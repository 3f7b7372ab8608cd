// SPDX-License-Identifier: BSD-3-Clause
// One file of tiles and its index (tile_record.hpp).
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

/// Where a tile lies in a segment.
struct TilePlace {
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
};

/// What an opening found.
struct SegmentContent {
  struct Tile {
    TileKey key;
    TilePlace place;
  };
  std::vector<Tile> tiles;    ///< in the order in which they were written
  std::uint64_t torn = 0;     ///< records whose writing was cut off
  std::uint64_t damaged = 0;  ///< stretches in which no record could be read
  std::string first_fault;    ///< file, place and rule of the first of these; empty if there was none
};

/// A file of records, written at its end only. One thread.
class TileSegment {
 public:
  enum class Access : std::uint8_t {
    kRead,   ///< leaves everything as it is
    kWrite,  ///< cuts off what was torn, writes a faulty index anew
  };

  /// Opens `NNNNNNNN.tiles` (and makes it, to write) with the index beside it, and says what is in it. Throws
  /// ServiceError where the file cannot be opened or read.
  TileSegment(std::filesystem::path tiles_file, Access access, SegmentContent& content);

  /// Writes a record at the end. False where the disk refuses; then the file is as it was before, and
  /// refusal() says why.
  bool append(const TileKey& key, std::span<const std::byte> bytes, TilePlace& place);

  /// Reads a tile and checks it. Null if all is well, else what is wrong; `bytes` is then empty.
  const char* read(const TileKey& key, const TilePlace& place, std::vector<std::byte>& bytes) const;

  /// Nothing is written any more: gives back the index's descriptor.
  void seal() { index_ = FileDescriptor(); }
  /// Waits until the disk has everything. False where it refuses.
  bool flush() noexcept;
  /// Removes both files; the tiles can be read until this object goes.
  void remove() noexcept;

  [[nodiscard]] const std::filesystem::path& file() const { return tiles_file_; }
  [[nodiscard]] std::uint64_t tile_bytes() const { return end_; }  ///< of the file of tiles
  [[nodiscard]] std::uint64_t disk_bytes() const { return end_ + index_end_; }
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
  std::uint64_t read_index(SegmentContent& content);
  void scan(std::uint64_t begin, std::uint64_t end, SegmentContent& content);
  [[nodiscard]] bool read_head(std::uint64_t offset, RecordHead& head) const;
  [[nodiscard]] std::uint64_t next_sound_head(std::uint64_t begin, std::uint64_t end) const;
  void note(SegmentContent& content, std::uint64_t offset, const char* rule) const;
  void repair(const SegmentContent& content);
  bool write_all(const FileDescriptor& file, std::span<const std::byte> bytes, std::uint64_t offset);

  std::filesystem::path tiles_file_;
  FileDescriptor tiles_;
  FileDescriptor index_;
  std::uint64_t end_ = 0;          ///< of the sound part of the file of tiles
  std::uint64_t index_end_ = 0;    ///< of the index
  std::uint64_t write_begun_ = 0;  ///< up to here the disk has been told to write
  bool index_is_whole_ = true;
  std::string refusal_;
  std::vector<std::byte> record_;  ///< scratch
};

}  // namespace isobar
