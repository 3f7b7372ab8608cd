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

/// Amount of unwritten data at which write-back to the disk is started, so that flush() returns quickly.
constexpr std::uint64_t kWriteBehindBytes = 1U << 20;

std::filesystem::path index_of(std::filesystem::path tiles_file) {
  return tiles_file.replace_extension(".index");
}

std::uint64_t size_of(const FileDescriptor& file, const std::filesystem::path& name) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) {
    throw ServiceError(name.string() + ": cannot be read: " + errno_message());
  }
  return static_cast<std::uint64_t>(status.st_size);
}

/// Fills `bytes` from the file. False if the file ends before or the disk refuses.
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

/// Entries of an index up to the first invalid one.
std::vector<IndexEntry> load_index(const FileDescriptor& file, std::uint64_t size) {
  std::vector<IndexEntry> entries(size / sizeof(IndexEntry));
  if (!read_all(file, std::as_writable_bytes(std::span(entries)), 0)) entries.clear();
  entries.erase(
      std::find_if_not(entries.begin(), entries.end(), [](const IndexEntry& e) { return e.is_valid(); }),
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
  // Failure to open the index is no error: all records are scanned instead.
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
  // Size of the tiles after reading the index: a writer appends the record before its entry, so that all
  // indexed records are inside.
  end_ = size_of(tiles_, tiles_file_);
  index_end_ = entries.size() * sizeof(IndexEntry);
  index_is_whole_ = index_ && index_end_ == index_size;
  content.tiles.reserve(entries.size());
  std::uint64_t at = 0;
  for (const IndexEntry& entry : entries) {
    const std::uint64_t next = entry.offset + record_bytes(entry.length);
    if (entry.offset < at) {  // the index of another file
      index_is_whole_ = false;
      break;
    }
    if (next > end_) {
      ++content.torn;
      note(content, entry.offset, "the file ends before the end of this tile");
      index_is_whole_ = false;
      // The records of all later entries are lost as well.
      const auto behind = static_cast<std::uint64_t>(&entries.back() - &entry);
      content.torn += behind;
      end_ = std::min<std::uint64_t>(end_, entry.offset);
      break;
    }
    if (entry.offset > at) {  // records without an entry: the disk was full when the entry was written
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
  std::uint64_t valid_end = begin;
  for (std::uint64_t at = begin; at < end;) {
    const bool valid = read_head(at, head) && head.is_valid();
    const std::uint64_t next = at + record_bytes(head.length);
    if (valid && next <= end && next <= std::numeric_limits<std::uint32_t>::max()) {
      content.tiles.push_back({head.key, {static_cast<std::uint32_t>(at), head.length}});
      at = valid_end = next;
      continue;
    }
    const std::uint64_t found = next_valid_head(at + kRecordAlignment, end);
    const bool at_the_end = end == end_ && found == end;
    note(content, at, at_the_end ? "the last record is incomplete" : "no valid record begins here");
    (at_the_end ? content.torn : content.damaged) += 1;
    // Truncates to the last valid record, which also drops a damaged stretch just before the torn record.
    if (at_the_end) end_ = valid_end;
    at = found;
  }
}

bool TileSegment::read_head(std::uint64_t offset, RecordHead& head) const {
  return read_all(tiles_, std::as_writable_bytes(std::span(&head, 1)), offset);
}

std::uint64_t TileSegment::next_valid_head(std::uint64_t begin, std::uint64_t end) const {
  std::array<std::byte, 1U << 16> block;  // NOLINT: uninitialised, filled by read_all()
  while (begin + sizeof(RecordHead) <= end) {
    const std::size_t size = std::min<std::uint64_t>(block.size(), end - begin);
    if (!read_all(tiles_, std::span(block).first(size), begin)) break;
    std::size_t i = 0;
    for (; i + sizeof(RecordHead) <= size; i += kRecordAlignment) {
      RecordHead head;
      std::memcpy(&head, block.data() + i, sizeof(head));
      if (head.is_valid()) return begin + i;
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
    throw ServiceError(tiles_file_.string() + ": an incomplete record cannot be removed: " + errno_message());
  }
  std::vector<IndexEntry> entries;
  entries.reserve(content.tiles.size());
  for (const auto& tile : content.tiles) {
    entries.push_back(IndexEntry::of(tile.key, tile.place.offset, tile.place.length));
  }
  // Failure to write the index is no error: the next opening rebuilds it from the heads.
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
      // Removes the partial write. If that fails as well, the next record overwrites it, and until then
      // opening the file finds it torn.
      static_cast<void>(::ftruncate(file.get(), static_cast<off_t>(offset)) == 0);
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    at += static_cast<std::uint64_t>(put);
  }
  return true;
}

bool TileSegment::append(const TileKey& key, std::span<const std::byte> bytes, TilePlace& place) {
  const RecordHead head = RecordHead::of(key, bytes);
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
  const IndexEntry entry = IndexEntry::of(key, place.offset, place.length);
  if (index_ && write_all(index_, std::as_bytes(std::span(&entry, 1)), index_end_)) {
    index_end_ += sizeof(entry);
  }
  return true;
}

const char* TileSegment::read(const TileKey& key, const TilePlace& place,
                              std::vector<std::byte>& bytes) const {
  bytes.clear();
  RecordHead head;
  if (!read_head(place.offset, head)) return "its head cannot be read";
  if (!head.is_valid()) return "its head is damaged";
  if (head.key != key || head.length != place.length) return "its head is that of another tile";
  bytes.resize(place.length);
  const char* fault = nullptr;
  if (!read_all(tiles_, bytes, std::uint64_t{place.offset} + sizeof(head))) {
    fault = "its bytes cannot be read";
  } else if (crc32_of(bytes) != head.bytes_crc) {
    fault = "its checksum is wrong";
  }
  if (fault != nullptr) bytes.clear();
  return fault;
}

FileDescriptor TileSegment::duplicate() const {
  return FileDescriptor(::fcntl(tiles_.get(), F_DUPFD_CLOEXEC, 0));
}

bool TileSegment::flush() noexcept { return ::fdatasync(tiles_.get()) == 0; }

void TileSegment::remove() noexcept {
  std::error_code ignored;  // a file that cannot be deleted is loaded, and compacted, by the next opening
  std::filesystem::remove(index_of(tiles_file_), ignored);
  std::filesystem::remove(tiles_file_, ignored);
}

}  // namespace isobar
