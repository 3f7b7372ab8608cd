// SPDX-License-Identifier: BSD-3-Clause
// The map on disk: every tile at the end of the newest file, an index in memory, files whose tiles are mostly
// superseded emptied and removed. All the work of a call is bounded by the size of a segment or of the tile.
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

#include "run/tile_store/map_folder.hpp"
#include "run/tile_store/tile_segment.hpp"
#include "run/tile_store/tile_store.hpp"

namespace isobar {

/// What the disk has to give.
struct TileStoreLimits {
  /// Bytes of all files of tiles and indices at most, 1 MiB … 1 TB. When a tile would not fit any more, the
  /// file that was begun longest ago goes with all its tiles.
  std::uint64_t max_bytes = 4'000'000'000;

  /// Size at which a file of tiles is closed and the next one begun: a 64th of the whole, so that little goes
  /// at once, but within 256 KiB … 1 GiB, so that the offsets fit and no more than some hundred files are
  /// open.
  [[nodiscard]] std::uint64_t segment_bytes() const;
};

/// What happened since the opening. The messages are those of the first case.
struct TileStoreCounters {
  std::uint64_t put = 0;
  std::uint64_t taken = 0;
  std::uint64_t refused = 0;  ///< tiles that the disk did not take
  std::string first_refusal;
  std::uint64_t damaged = 0;  ///< tiles that could not be read, and stretches without any that can
  std::string first_damage;
  std::uint64_t torn = 0;       ///< records whose writing was cut off, found by the opening
  std::uint64_t forgotten = 0;  ///< tiles that had to go because of the limit
  std::uint64_t moved = 0;      ///< tiles written again so that their file could go
};

/// A map in a folder. One thread; the constructor throws, the rest returns false and counts.
class FileTileStore : public TileStore {
 public:
  /// Opens the map of a folder to look at it. It may be written by another process meanwhile: what is seen is
  /// the map of this moment. Throws DataError where there is no map of a known format, ServiceError.
  [[nodiscard]] static std::unique_ptr<FileTileStore> open_to_read(const std::filesystem::path& directory);
  /// Opens the map of a folder, repairs it after a crash and goes on with it. Throws as above, also where the
  /// map was made with another header or somebody writes it.
  [[nodiscard]] static std::unique_ptr<FileTileStore> open_to_continue(const std::filesystem::path& directory,
                                                                       const MapHeader& header,
                                                                       const TileStoreLimits& limits);
  /// Begins an empty map in the folder, in place of the one that may be there. Throws ServiceError.
  [[nodiscard]] static std::unique_ptr<FileTileStore> create(const std::filesystem::path& directory,
                                                             const MapHeader& header,
                                                             const TileStoreLimits& limits);

  bool put(const TileKey& key, std::span<const std::byte> bytes) override;
  bool take(const TileKey& key, std::vector<std::byte>& bytes) override;
  [[nodiscard]] bool contains(const TileKey& key) const override { return tiles_.contains(key); }
  [[nodiscard]] std::vector<TileKey> keys() const override { return sorted_keys(tiles_); }

  [[nodiscard]] const MapHeader& header() const { return header_; }
  [[nodiscard]] const TileStoreCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }
  [[nodiscard]] std::size_t segment_count() const { return segments_.size(); }
  /// Of the newest versions, with their heads.
  [[nodiscard]] std::uint64_t live_bytes() const;
  [[nodiscard]] std::uint64_t disk_bytes() const { return disk_bytes_; }
  /// What was wrong with the tile that take() last found damaged: file, place, rule.
  [[nodiscard]] const std::string& last_damage() const { return last_damage_; }

 private:
  struct Segment {
    TileSegment file;
    std::uint64_t live_bytes = 0;
    std::vector<TileKey> keys{};  ///< of its records in their order, superseded ones too
  };
  struct Location {
    std::uint32_t segment = 0;
    TilePlace place;
  };
  /// A segment whose living tiles are being moved to the newest one.
  struct Compaction {
    std::uint32_t segment = 0;
    std::uint32_t first_target = 0;  ///< the oldest segment that took some of them
    std::size_t next = 0;            ///< in its keys
  };

  FileTileStore(std::filesystem::path directory, const MapHeader& header, const TileStoreLimits& limits,
                std::optional<MapLock> lock);
  /// False if a file vanished meanwhile, which only a reader meets.
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
  std::optional<MapLock> lock_;  ///< none: this object only reads
  std::map<std::uint32_t, Segment> segments_;
  std::unordered_map<TileKey, Location, TileKeyHash> tiles_;
  std::optional<Compaction> compaction_;
  std::uint64_t disk_bytes_ = 0;
  std::uint32_t next_number_ = 0;
  TileStoreCounters counters_;
  std::string last_damage_;
  std::vector<std::byte> moving_;  ///< scratch
};

}  // namespace isobar
