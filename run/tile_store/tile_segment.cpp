// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/tile_segment.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

#include "core/errors.hpp"

namespace isobar {

namespace {

/// The disk is told to write when this much waits, so that flush() finds little to wait for.
constexpr std::uint64_t kWriteBehindBytes = 1U << 20;

std::filesystem::path index_of(std::filesystem::path tiles_file) {
  return tiles_file.replace_extension(".index");
}

std::uint64_t size_of(const FileDescriptor& file, const std::filesystem::path& name) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0)
    throw ServiceError(name.string() + ": cannot be read: " + errno_message());
  return static_cast<std::uint64_t>(status.st_size);
}

/// Reads until `bytes` is full. False at the end of the file and where the disk refuses.
bool read_all(const FileDescriptor& file, std::span<std::byte> bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return true;
}

/// What an index says, up to its first bad entry.
std::vector<IndexEntry> load_index(const FileDescriptor& file, std::uint64_t size) {
  std::vector<IndexEntry> entries(size / sizeof(IndexEntry));
  if (!read_all(file, std::as_writable_bytes(std::span(entries)), 0)) entries.clear();
  entries.erase(
      std::find_if_not(entries.begin(), entries.end(), [](const IndexEntry& e) { return is_sound(e); }),
      entries.end());
  return entries;
}

}  // namespace

TileSegment::TileSegment(std::filesystem::path tiles_file, Access access, SegmentContent& content)
    : tiles_file_(std::move(tiles_file)) {
  const bool writes = access == Access::kWrite;
  const int flags = (writes ? O_RDWR | O_CREAT : O_RDONLY) | O_CLOEXEC;
  tiles_ = FileDescriptor(::open(tiles_file_.c_str(), flags, 0644));
  if (!tiles_) throw ServiceError(tiles_file_.string() + ": cannot be opened: " + errno_message());
  // An index that cannot be opened costs time and nothing else.
  index_ = FileDescriptor(::open(index_of(tiles_file_).c_str(), flags, 0644));
  const std::uint64_t indexed_end = read_index(content);
  if (end_ > indexed_end) scan(indexed_end, end_, content);
  if (writes && !index_is_whole_) repair(content);
  write_begun_ = end_;
}

std::uint64_t TileSegment::read_index(SegmentContent& content) {
  std::vector<IndexEntry> entries;
  std::uint64_t index_size = 0;
  if (index_) {
    index_size = size_of(index_, index_of(tiles_file_));
    entries = load_index(index_, index_size);
  }
  // After the index, so that the records of all its entries are there even while somebody writes.
  end_ = size_of(tiles_, tiles_file_);
  index_end_ = entries.size() * sizeof(IndexEntry);
  index_is_whole_ = index_ && index_end_ == index_size;
  content.tiles.reserve(entries.size());
  std::uint64_t at = 0;
  for (const IndexEntry& entry : entries) {
    const std::uint64_t next = entry.offset + record_bytes(entry.length);
    if (entry.offset < at) {  // no index of this file
      index_is_whole_ = false;
      break;
    }
    if (next > end_) {
      ++content.torn;
      note(content, entry.offset, "the file ends before the end of this tile");
      index_is_whole_ = false;
      // Nothing behind it can be there; each entry is a tile that is lost.
      const auto behind = static_cast<std::uint64_t>(&entries.back() - &entry);
      content.torn += behind;
      end_ = std::min<std::uint64_t>(end_, entry.offset);
      break;
    }
    if (entry.offset > at) {  // the disk was full for the index, not for the tiles
      index_is_whole_ = false;
      scan(at, entry.offset, content);
    }
    content.tiles.push_back({entry.key, {entry.offset, entry.length}});
    at = next;
  }
  return at;
}

void TileSegment::scan(std::uint64_t begin, std::uint64_t end, SegmentContent& content) {
  index_is_whole_ = false;
  RecordHead head;
  std::uint64_t sound_end = begin;
  for (std::uint64_t at = begin; at < end;) {
    const bool sound = read_head(at, head) && is_sound(head);
    const std::uint64_t next = at + record_bytes(head.length);
    if (sound && next <= end && next <= std::numeric_limits<std::uint32_t>::max()) {
      content.tiles.push_back({head.key, {static_cast<std::uint32_t>(at), head.length}});
      at = sound_end = next;
      continue;
    }
    const std::uint64_t found = next_sound_head(at + kRecordAlignment, end);
    const bool at_the_end = end == end_ && found == end;
    note(content, at, at_the_end ? "the last record was cut off" : "no head of a tile can be read here");
    (at_the_end ? content.torn : content.damaged) += 1;
    // With what is damaged just before it: nothing in there can be read either.
    if (at_the_end) end_ = sound_end;
    at = found;
  }
}

bool TileSegment::read_head(std::uint64_t offset, RecordHead& head) const {
  return read_all(tiles_, std::as_writable_bytes(std::span(&head, 1)), offset);
}

std::uint64_t TileSegment::next_sound_head(std::uint64_t begin, std::uint64_t end) const {
  std::array<std::byte, 1U << 16> block;  // NOLINT: filled by the read
  while (begin + sizeof(RecordHead) <= end) {
    const std::size_t size = std::min<std::uint64_t>(block.size(), end - begin);
    if (!read_all(tiles_, std::span(block).first(size), begin)) break;
    std::size_t i = 0;
    for (; i + sizeof(RecordHead) <= size; i += kRecordAlignment) {
      RecordHead head;
      std::memcpy(&head, block.data() + i, sizeof(head));
      if (is_sound(head)) return begin + i;
    }
    begin += i;
  }
  return end;
}

void TileSegment::note(SegmentContent& content, std::uint64_t offset, const char* rule) const {
  if (content.first_fault.empty()) {
    content.first_fault = tiles_file_.string() + ": byte " + std::to_string(offset) + ": " + rule;
  }
}

void TileSegment::repair(const SegmentContent& content) {
  if (::ftruncate(tiles_.get(), static_cast<off_t>(end_)) != 0) {
    throw ServiceError(tiles_file_.string() + ": a torn record cannot be cut off: " + errno_message());
  }
  std::vector<IndexEntry> entries;
  entries.reserve(content.tiles.size());
  for (const auto& tile : content.tiles) {
    entries.push_back(make_entry(tile.key, tile.place.offset, tile.place.length));
  }
  // An index that cannot be written is made again from the heads by the next opening.
  index_end_ = 0;
  if (!index_ || ::ftruncate(index_.get(), 0) != 0) return;
  const auto bytes = std::as_bytes(std::span(entries));
  index_end_ = write_all(index_, bytes, 0) ? bytes.size() : 0;
  index_is_whole_ = index_end_ == bytes.size();
}

bool TileSegment::write_all(const FileDescriptor& file, std::span<const std::byte> bytes,
                            std::uint64_t offset) {
  std::uint64_t at = offset;
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) {
      refusal_ = put == 0 ? "nothing was written" : errno_message();
      // What was begun must not stand before the next record. Should that fail, too, the next record
      // overwrites it, and an opening finds it torn.
      static_cast<void>(::ftruncate(file.get(), static_cast<off_t>(offset)) == 0);
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    at += static_cast<std::uint64_t>(put);
  }
  return true;
}

bool TileSegment::append(const TileKey& key, std::span<const std::byte> bytes, TilePlace& place) {
  const RecordHead head = make_head(key, bytes);
  record_.assign(record_bytes(bytes.size()), std::byte{0});
  std::memcpy(record_.data(), &head, sizeof(head));
  std::memcpy(record_.data() + sizeof(head), bytes.data(), bytes.size());
  if (!write_all(tiles_, record_, end_)) return false;
  place = {static_cast<std::uint32_t>(end_), head.length};
  end_ += record_.size();
  if (end_ - write_begun_ >= kWriteBehindBytes) {
    static_cast<void>(::sync_file_range(tiles_.get(), static_cast<off64_t>(write_begun_),
                                        static_cast<off64_t>(end_ - write_begun_),
                                        SYNC_FILE_RANGE_WRITE) == 0);
    write_begun_ = end_;
  }
  const IndexEntry entry = make_entry(key, place.offset, place.length);
  if (index_ && write_all(index_, std::as_bytes(std::span(&entry, 1)), index_end_))
    index_end_ += sizeof(entry);
  return true;
}

const char* TileSegment::read(const TileKey& key, const TilePlace& place,
                              std::vector<std::byte>& bytes) const {
  bytes.clear();
  RecordHead head;
  if (!read_head(place.offset, head)) return "its head cannot be read";
  if (!is_sound(head)) return "its head is damaged";
  if (head.key != key || head.length != place.length) return "its head is another tile's";
  bytes.resize(place.length);
  const char* fault = nullptr;
  if (!read_all(tiles_, bytes, std::uint64_t{place.offset} + sizeof(head))) {
    fault = "its bytes cannot be read";
  } else if (checksum(bytes) != head.bytes_crc) {
    fault = "its checksum is wrong";
  }
  if (fault != nullptr) bytes.clear();
  return fault;
}

bool TileSegment::flush() noexcept { return ::fdatasync(tiles_.get()) == 0; }

void TileSegment::remove() noexcept {
  std::error_code ignored;  // the file that stays is counted as used by the next opening, and goes then
  std::filesystem::remove(index_of(tiles_file_), ignored);
  std::filesystem::remove(tiles_file_, ignored);
}

}  // namespace isobar
