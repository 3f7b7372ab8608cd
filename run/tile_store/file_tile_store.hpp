// SPDX-License-Identifier: BSD-3-Clause
// Map on disk as a log-structured store: tiles are appended to the newest of several segment files, an index
// in memory holds the newest version of each tile, and compaction removes segments that are mostly
// superseded. The work of one call is bounded by the size of a segment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/map/tile_storage.hpp"
#include "run/tile_store/map_folder.hpp"
#include "run/tile_store/tile_segment.hpp"

namespace isobar {

/// Limits of the disk space.
struct TileStoreLimits {
  /// Maximum size of all segments and indices together, 1 MiB … 1 TB. When a new tile would exceed it, the
  /// oldest segment is removed with all its tiles.
  std::uint64_t max_bytes = 4'000'000'000;

  /// Size at which a segment is closed and the next one begun: max_bytes / 64, so that the limit costs few
  /// tiles at once, clamped to 256 KiB … 1 GiB, so that 32-bit offsets suffice and few files are open.
  [[nodiscard]] std::uint64_t segment_bytes() const;
};

/// Events since the store was opened. Each message is that of the first event.
struct TileStoreCounters {
  std::uint64_t put = 0;      ///< tiles written
  std::uint64_t taken = 0;    ///< tiles read
  std::uint64_t refused = 0;  ///< tiles not written because the disk or a limit refused
  std::string first_refusal;
  std::uint64_t damaged = 0;  ///< unreadable tiles, and unreadable stretches between tiles
  std::string first_damage;
  std::uint64_t torn = 0;       ///< records that a crash left incomplete, found when the store was opened
  std::uint64_t forgotten = 0;  ///< tiles removed because of max_bytes
  std::uint64_t moved = 0;      ///< tiles rewritten by compaction
};

/// Map in a folder. One thread. The named constructors throw; all other functions count errors and return
/// false.
class FileTileStore : public TileStorage {
 public:
  /// Opens a map read-only, as it is at this moment; another process may be writing it.
  /// @throws DataError when the folder holds no map of a known format
  /// @throws ServiceError when a file cannot be opened or read
  [[nodiscard]] static std::unique_ptr<FileTileStore> open_to_read(const std::filesystem::path& directory);
  /// Opens a map for writing and repairs it after a crash.
  /// @throws DataError when the folder holds no map of a known format, or one with another header
  /// @throws ServiceError when a file cannot be opened or repaired, or another process writes the map
  [[nodiscard]] static std::unique_ptr<FileTileStore> open_to_continue(const std::filesystem::path& directory,
                                                                       const MapHeader& header,
                                                                       const TileStoreLimits& limits);
  /// Creates an empty map for writing; a map that is already in the folder is deleted.
  /// @throws ServiceError when a file cannot be created or deleted, or another process writes the map
  [[nodiscard]] static std::unique_ptr<FileTileStore> create(const std::filesystem::path& directory,
                                                             const MapHeader& header,
                                                             const TileStoreLimits& limits);

  bool put(const TileKey& key, std::span<const std::byte> bytes) override;
  bool take(const TileKey& key, std::vector<std::byte>& bytes) override;
  [[nodiscard]] bool contains(const TileKey& key) const override { return tiles_.contains(key); }
  /// The newest segment, for a thread that waits until it is on the disk; older ones are there already.
  [[nodiscard]] FileDescriptor newest_file() const;
  /// True while the folder holds the files of this store: nobody has deleted or replaced them.
  [[nodiscard]] bool in_place() const;
  /// Keys of all tiles, sorted by x, y, z.
  [[nodiscard]] std::vector<TileKey> keys() const { return TileKey::sorted(tiles_); }

  [[nodiscard]] const MapHeader& header() const { return header_; }
  [[nodiscard]] const TileStoreCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }
  [[nodiscard]] std::size_t segment_count() const { return segments_.size(); }
  /// Size of the newest versions of all tiles, including their record heads.
  [[nodiscard]] std::uint64_t live_bytes() const;
  /// Size of all segments and indices.
  [[nodiscard]] std::uint64_t disk_bytes() const { return disk_bytes_; }
  /// The last damage that take() found: file, offset, tile, rule.
  [[nodiscard]] const std::string& last_damage() const { return last_damage_; }

 private:
  struct Segment {
    TileSegment file;
    std::uint64_t live_bytes = 0;
    std::vector<TileKey> keys{};  ///< of all records in their order, including superseded ones
  };
  struct Location {
    std::uint32_t segment = 0;
    TilePlace place;
  };
  /// Progress of moving the live tiles of a segment to the newest segment.
  struct Compaction {
    std::uint32_t segment = 0;
    std::uint32_t first_target = 0;  ///< oldest segment that received tiles
    std::size_t next = 0;            ///< index in Segment::keys of the next tile to move
  };

  FileTileStore(std::filesystem::path directory, const MapHeader& header, const TileStoreLimits& limits,
                std::optional<MapLock> lock);
  /// Returns false if a writer removed a file between listing and opening it; never for the writer itself.
  [[nodiscard]] bool load(TileSegment::Access access);
  void add_location(std::uint32_t number, Segment& segment, const TileKey& key, const TilePlace& place);
  void drop_location(const TileKey& key);
  bool append(const TileKey& key, std::span<const std::byte> bytes);
  Segment* segment_for(std::uint64_t bytes);
  void make_room(std::uint64_t bytes);
  void forget_oldest();
  void erase_segment(std::uint32_t number);
  void choose_compaction();
  void compact(std::uint64_t budget_bytes);
  void finish_compaction();
  void refuse(const std::string& why);
  void note_damage(const Segment& segment, const TileKey& key, const TilePlace& place, const char* rule);

  std::filesystem::path directory_;
  MapHeader header_;
  TileStoreLimits limits_;
  std::optional<MapLock> lock_;                ///< none: read-only
  std::map<std::uint32_t, Segment> segments_;  ///< by number; the last one is the newest and is written
  std::unordered_map<TileKey, Location, TileKey::Hash> tiles_;
  std::optional<Compaction> compaction_;
  std::uint64_t disk_bytes_ = 0;
  std::uint32_t next_number_ = 0;
  TileStoreCounters counters_;
  std::string last_damage_;
  std::vector<std::byte> moving_;  ///< scratch
};

}  // namespace isobar
