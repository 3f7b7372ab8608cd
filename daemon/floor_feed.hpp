// SPDX-License-Identifier: BSD-3-Clause
// Points of the map for the floors: from the thread of the map to that of the floors.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "core/map/local_map.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Points of one tile of the map.
struct FloorTile {
  TileKey key;
  std::vector<MapPoint> points;  ///< map frame
};

/// Some tiles of the map.
struct FloorTiles {
  std::uint32_t session = 0;    ///< number of the map frame
  std::uint32_t map_moves = 0;  ///< corrections of it, see MapMove
  std::vector<FloorTile> tiles;
  bool is_whole = false;  ///< with these, every tile has come that was asked for
};

/// Hands over the points of the map when the consumer asks, for some milliseconds a scan, so that no scan waits: all tiles
/// in memory, the nearest first, and those on the disk that have not been handed over since they were written.
/// ask() and take(): the consumer's thread; step(): the map's. The lock between them is held for the time of a move.
class FloorFeed {
 public:
  /// Time for one step [ns]: a fiftieth of the time between two scans. One tile at least.
  static constexpr std::int64_t kStepNs = 2'000'000;
  /// Points that may wait for the consumer; then the map's thread pauses.
  static constexpr std::size_t kMostWaiting = 500'000;

  explicit FloorFeed(std::int64_t step_ns = kStepNs) : step_ns_(step_ns) {}

  /// Asks for the map as it is; answered by the next steps.
  void ask() noexcept { asked_.store(true, std::memory_order_release); }
  /// What has come since the last call.
  [[nodiscard]] FloorTiles take();

  /// Hands over some tiles. @param store of the map; may be null
  void step(const LocalMap& map, FileTileStore* store, const Eigen::Vector3d& p_map_base) noexcept;

 private:
  void list_tiles(const LocalMap& map, const FileTileStore* store, const Eigen::Vector3d& p_map_base);
  [[nodiscard]] bool has_room();
  void read(const TileKey& key, const LocalMap& map, FileTileStore* store, FloorTile& tile);
  void hand_over(FloorTiles&& next);

  std::int64_t step_ns_;
  std::atomic<bool> asked_{false};
  // Of the map's thread.
  std::uint32_t session_ = 0;
  std::uint32_t map_moves_ = 0;
  bool is_listed_ = false;
  std::vector<TileKey> to_read_;  ///< the nearest last
  std::unordered_map<TileKey, bool, TileKey::Hash>
      handed_over_;               ///< true: from memory, where it may have changed
  std::vector<std::byte> bytes_;  ///< scratch
  // Of both.
  std::mutex mutex_;
  FloorTiles waiting_;
  std::size_t waiting_points_ = 0;
};

}  // namespace isobar
