// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/file_tile_store.hpp"

#include <algorithm>
#include <utility>

#include "core/errors.hpp"

namespace isobar {

namespace {

/// Share of superseded bytes at which a segment is compacted: compaction then rewrites at most as many bytes
/// as it frees.
constexpr double kDeadShare = 0.5;
/// The same when the disk space is used up to kNearLimit (share of max_bytes): superseded versions are
/// removed before the limit costs a live tile.
constexpr double kDeadShareNearLimit = 0.25;
constexpr double kNearLimit = 0.75;
/// Bytes that compaction may rewrite per put() in addition to the size of the tile put, so that compaction
/// keeps ahead of small tiles.
constexpr std::uint64_t kExtraMovedBytes = std::uint64_t{64} * 1024;
/// Cost of skipping a superseded tile, counted as rewritten bytes: it bounds the loop as well.
constexpr std::uint64_t kSkippedBytes = 256;

}  // namespace

std::uint64_t TileStoreLimits::segment_bytes() const {
  return std::clamp<std::uint64_t>(max_bytes / 64, std::uint64_t{256} * 1024, std::uint64_t{1} << 30);
}

FileTileStore::FileTileStore(std::filesystem::path directory, const MapHeader& header,
                             const TileStoreLimits& limits, std::optional<MapLock> lock)
    : directory_(std::move(directory)), header_(header), limits_(limits), lock_(std::move(lock)) {}

std::unique_ptr<FileTileStore> FileTileStore::open_to_read(const std::filesystem::path& directory) {
  const MapHeader header = read_map_header(directory);
  // Retry: the writer may remove a segment between listing and opening it; its tiles are then in a later one.
  constexpr int kAttempts = 10;
  for (int attempt = 1; attempt <= kAttempts; ++attempt) {
    std::unique_ptr<FileTileStore> store(new FileTileStore(directory, header, {}, std::nullopt));
    if (store->load(TileSegment::Access::kRead)) return store;
  }
  throw ServiceError(directory.string() + ": cannot be opened: another process keeps removing its files");
}

std::unique_ptr<FileTileStore> FileTileStore::open_to_continue(const std::filesystem::path& directory,
                                                               const MapHeader& header,
                                                               const TileStoreLimits& limits) {
  const MapHeader found = read_map_header(directory);
  if (found != header) {
    throw DataError((directory / "map.toml").string() + ": the map has tiles of " +
                    std::to_string(found.tile_m) + " m with cells of " + std::to_string(found.cell_m) +
                    " m; the configuration requires tiles of " + std::to_string(header.tile_m) +
                    " m with cells of " + std::to_string(header.cell_m) + " m");
  }
  std::unique_ptr<FileTileStore> store(new FileTileStore(directory, header, limits, MapLock(directory)));
  static_cast<void>(store->load(TileSegment::Access::kWrite));
  return store;
}

std::unique_ptr<FileTileStore> FileTileStore::create(const std::filesystem::path& directory,
                                                     const MapHeader& header, const TileStoreLimits& limits) {
  MapLock lock(directory);
  remove_map(directory);
  write_map_header(directory, header);
  return std::unique_ptr<FileTileStore>(new FileTileStore(directory, header, limits, std::move(lock)));
}

bool FileTileStore::load(TileSegment::Access access) {
  for (const std::uint32_t number : file_numbers(directory_, kTilesExtension)) {
    SegmentContent content;
    const auto file = numbered_file(directory_, number, kTilesExtension);
    std::optional<TileSegment> opened;
    try {
      opened.emplace(file, access, content);
    } catch (const ServiceError&) {
      if (lock_ || std::filesystem::exists(file)) throw;
      return false;
    }
    Segment& segment = segments_.emplace(number, Segment{std::move(*opened)}).first->second;
    segment.keys.reserve(content.tiles.size());
    for (const auto& tile : content.tiles) add_location(number, segment, tile.key, tile.place);
    disk_bytes_ += segment.file.disk_bytes();
    next_number_ = number + 1;
    counters_.torn += content.torn;
    counters_.damaged += content.damaged;
    if (counters_.first_damage.empty()) counters_.first_damage = content.first_fault;
  }
  for (auto& [number, segment] : segments_) {
    if (number != segments_.rbegin()->first) segment.file.seal();
  }
  return true;
}

std::uint64_t FileTileStore::live_bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [number, segment] : segments_) sum += segment.live_bytes;
  return sum;
}

bool FileTileStore::put(const TileKey& key, std::span<const std::byte> bytes) {
  if (!lock_) {
    refuse(directory_.string() + ": the map was opened read-only");
    return false;
  }
  if (bytes.empty() || bytes.size() > kMaxTileBytes || record_bytes(bytes.size()) > limits_.max_bytes / 2) {
    refuse(directory_.string() + ": a tile of " + std::to_string(bytes.size()) +
           " bytes; must have at least 1 byte and fill at most half of the disk limit");
    return false;
  }
  if (!append(key, bytes)) return false;
  ++counters_.put;
  compact(record_bytes(bytes.size()) + kExtraMovedBytes);
  return true;
}

bool FileTileStore::take(const TileKey& key, std::vector<std::byte>& bytes) {
  bytes.clear();
  const auto found = tiles_.find(key);
  if (found == tiles_.end()) return false;
  const Location at = found->second;
  const Segment& segment = segments_.at(at.segment);
  if (const char* fault = segment.file.read(key, at.place, bytes)) {
    note_damage(segment, key, at.place, fault);
    drop_location(key);
    return false;
  }
  ++counters_.taken;
  return true;
}

void FileTileStore::add_location(std::uint32_t number, Segment& segment, const TileKey& key,
                                 const TilePlace& place) {
  drop_location(key);
  tiles_[key] = {number, place};
  segment.keys.push_back(key);
  segment.live_bytes += record_bytes(place.length);
}

void FileTileStore::drop_location(const TileKey& key) {
  const auto found = tiles_.find(key);
  if (found == tiles_.end()) return;
  segments_.at(found->second.segment).live_bytes -= record_bytes(found->second.place.length);
  tiles_.erase(found);
}

bool FileTileStore::append(const TileKey& key, std::span<const std::byte> bytes) {
  const std::uint64_t size = record_bytes(bytes.size());
  make_room(size);
  Segment* segment = segment_for(size);
  if (segment == nullptr) return false;
  const std::uint64_t before = segment->file.disk_bytes();
  TilePlace place;
  if (!segment->file.append(key, bytes, place)) {
    refuse(segment->file.file().string() + ": " + segment->file.refusal());
    return false;
  }
  disk_bytes_ += segment->file.disk_bytes() - before;
  add_location(segments_.rbegin()->first, *segment, key, place);
  return true;
}

FileTileStore::Segment* FileTileStore::segment_for(std::uint64_t bytes) {
  if (!segments_.empty()) {
    Segment& newest = segments_.rbegin()->second;
    const std::uint64_t used = newest.file.tile_bytes();
    if (used == 0 || used + bytes <= limits_.segment_bytes()) return &newest;
    newest.file.seal();
    if (!newest.file.flush()) refuse(newest.file.file().string() + ": cannot be written to the disk");
  }
  try {
    SegmentContent content;
    TileSegment file(numbered_file(directory_, next_number_, kTilesExtension), TileSegment::Access::kWrite,
                     content);
    sync_folder(directory_);
    return &segments_.emplace(next_number_++, Segment{std::move(file)}).first->second;
  } catch (const Error& error) {
    refuse(error.what());
    return nullptr;
  }
}

void FileTileStore::make_room(std::uint64_t bytes) {
  while (disk_bytes_ + bytes + sizeof(IndexEntry) > limits_.max_bytes && !segments_.empty()) forget_oldest();
}

void FileTileStore::forget_oldest() {
  const std::uint32_t number = segments_.begin()->first;
  for (const TileKey& key : segments_.begin()->second.keys) {
    const auto found = tiles_.find(key);
    if (found == tiles_.end() || found->second.segment != number) continue;
    tiles_.erase(found);
    ++counters_.forgotten;
  }
  erase_segment(number);
}

void FileTileStore::erase_segment(std::uint32_t number) {
  Segment& segment = segments_.at(number);
  disk_bytes_ -= segment.file.disk_bytes();
  segment.file.remove();
  segments_.erase(number);
  if (compaction_ && compaction_->segment == number) compaction_.reset();
}

void FileTileStore::choose_compaction() {
  const auto near = static_cast<double>(limits_.max_bytes) * kNearLimit;
  const double share = static_cast<double>(disk_bytes_) > near ? kDeadShareNearLimit : kDeadShare;
  double most = share;
  for (const auto& [number, segment] : segments_) {
    const auto size = static_cast<double>(segment.file.tile_bytes());
    const double dead = size - static_cast<double>(segment.live_bytes);
    // The newest segment is still being written.
    if (number == segments_.rbegin()->first || size == 0.0 || dead / size < most) continue;
    most = dead / size;
    compaction_ = {number, segments_.rbegin()->first, 0};
  }
}

void FileTileStore::compact(std::uint64_t budget_bytes) {
  if (!compaction_) choose_compaction();
  std::uint64_t spent = 0;
  while (compaction_ && spent < budget_bytes) {
    const std::uint32_t number = compaction_->segment;
    const Segment& segment = segments_.at(number);
    if (compaction_->next == segment.keys.size()) {
      finish_compaction();
      return;
    }
    const TileKey key = segment.keys[compaction_->next];
    const auto found = tiles_.find(key);
    if (found == tiles_.end() || found->second.segment != number) {
      ++compaction_->next;
      spent += kSkippedBytes;
      continue;
    }
    const TilePlace place = found->second.place;
    if (const char* fault = segment.file.read(key, place, moving_)) {
      note_damage(segment, key, place, fault);
      drop_location(key);
      continue;
    }
    // Making room may remove the oldest segment, which may be the one being compacted.
    make_room(record_bytes(moving_.size()));
    if (!compaction_ || !append(key, moving_)) return;
    ++counters_.moved;
    ++compaction_->next;
    spent += record_bytes(moving_.size());
  }
}

void FileTileStore::finish_compaction() {
  // Flush before removal: a power failure must not lose both copies of a tile.
  for (auto target = segments_.lower_bound(compaction_->first_target); target != segments_.end(); ++target) {
    if (target->second.file.flush()) continue;
    refuse(target->second.file.file().string() + ": cannot be written to the disk");
    compaction_.reset();
    return;
  }
  erase_segment(compaction_->segment);
}

FileDescriptor FileTileStore::newest_file() const {
  return segments_.empty() ? FileDescriptor() : segments_.rbegin()->second.file.duplicate();
}

bool FileTileStore::in_place() const { return !lock_ || lock_->in_place(); }

void FileTileStore::refuse(const std::string& why) {
  if (counters_.refused++ == 0) counters_.first_refusal = why;
}

void FileTileStore::note_damage(const Segment& segment, const TileKey& key, const TilePlace& place,
                                const char* rule) {
  last_damage_ = segment.file.file().string() + ": byte " + std::to_string(place.offset) + ": tile (" +
                 std::to_string(key.x) + ", " + std::to_string(key.y) + ", " + std::to_string(key.z) +
                 "): " + rule;
  if (counters_.damaged++ == 0 || counters_.first_damage.empty()) counters_.first_damage = last_damage_;
}

}  // namespace isobar
