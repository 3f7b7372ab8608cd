// SPDX-License-Identifier: BSD-3-Clause
// The whole map as points for viewers: tiles in memory, and those that are only on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/map/local_map.hpp"
#include "ipc/shared_memory.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Publishes clouds of the map, a step a scan, so that a large map fills neither the shared memory nor the time
/// of one update: first reads the tiles that are only on disk, for 2 ms a step, the nearest first; then adds
/// those in memory, as they are by then; then sends one piece a step. Only with a subscriber. The map's thread.
class MapCloudPublisher {
 public:
  /// Most points of the tiles on disk in one cloud: 64 MB. Farther tiles are left out; `isobar map export` has
  /// them.
  static constexpr std::size_t kMostStoredPoints = 4'000'000;

  /// Time for reading tiles in one step [ns]: a fiftieth of the time between two scans. One tile at least.
  static constexpr std::int64_t kReadingTimeNs = 2'000'000;

  explicit MapCloudPublisher(double interval_s, std::int64_t reading_time_ns = kReadingTimeNs)
      : reading_time_ns_(reading_time_ns) {
    set_interval(interval_s);
  }

  /// @param interval_s time from the beginning of one cloud to that of the next
  void set_interval(double interval_s) { interval_ns_ = static_cast<std::int64_t>(interval_s * 1e9); }
  /// Drops the cloud that is on its way: another map follows.
  void start_over() noexcept;
  /// Next step, after a scan with this pose.
  /// @param store of the map; may be null
  void step(const LocalMap& map, FileTileStore* store, const PoseEstimate& pose) noexcept;

 private:
  enum class Stage : std::uint8_t { kIdle, kReading, kSending };
  /// Points of a stored tile.
  struct Stored {
    TileKey key;
    std::size_t first = 0;
    std::size_t count = 0;
  };

  void release() noexcept;
  void list_tiles(const LocalMap& map, const FileTileStore* store, const Eigen::Vector3d& p_map_base);
  void read_some(const LocalMap& map, FileTileStore* store);
  void read(const TileKey& key, FileTileStore& store);
  void add_tiles_in_memory(const LocalMap& map);
  void append(const std::vector<MapPoint>& points);
  void send_piece(std::uint32_t session) noexcept;

  ipc::Publisher<ipc::MapCloud> clouds_{ipc::topics::kMapCloud};
  std::int64_t reading_time_ns_;
  std::int64_t interval_ns_ = 0;
  std::int64_t began_ns_ = 0;  ///< stamp of the scan with which the last cloud began
  std::int64_t stamp_ns_ = 0;
  std::uint32_t sequence_ = 0;
  Stage stage_ = Stage::kIdle;
  std::vector<TileKey> to_read_;    ///< the nearest last
  std::vector<TileKey> in_memory_;  ///< tiles of the store that were in memory when the cloud began
  std::vector<Stored> stored_;
  std::vector<ScanPoint> points_;
  std::size_t sent_ = 0;              ///< of points_
  bool told_left_out_ = false;        ///< a line is in the log
  std::vector<MapPoint> map_points_;  ///< scratch
  std::vector<std::byte> bytes_;      ///< scratch
};

}  // namespace isobar
