// SPDX-License-Identifier: BSD-3-Clause
// A run through the ring of corridors as a map and its building have it, in a map frame of its own.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/loops/building_storage.hpp"
#include "core/map/local_map.hpp"
#include "core/merge/building_merger.hpp"
#include "core/place/known_map.hpp"
#include "tests/core/loops/ring_run.hpp"

namespace isobar::test {

/// Storage in memory.
class MemoryStorage final : public BuildingStorage {
 public:
  void add_submap(const Submap& submap) override;
  void add_key(std::size_t submap, KeyScan& key, const RegisteredScan& scan) override;
  void add_loop(const Loop& loop) override { stored.loops.push_back(loop); }
  void add_move(std::int64_t /*stamp_ns*/) override {}
  bool read_scan(ScanHandle handle, RegisteredScan& out) override;

  StoredBuilding stored;
  std::size_t lost_every = 0;  ///< of so many scans one cannot be read; 0: none

 private:
  struct Scan {
    PoseEstimate pose;
    std::vector<ScanPoint> points;
  };
  std::vector<Scan> scans_;
};

/// What a session differs by.
struct RingSessionWish {
  Eigen::Isometry3d T_map_world = Eigen::Isometry3d::Identity();  ///< of its map frame
  double from_m = 0.0;                                            ///< way along the ring
  double until_m = 35.0;
  World world = ring_of_corridors();
  double storey_m = 0.0;  ///< it drives on a floor that looks the same, this much above
};

/// Drives along the ring; fills building and map.
void drive_ring(const RingSessionWish& wish, BuildingStorage& storage, LocalMap& map);

/// A session with its map.
class RingSession {
 public:
  explicit RingSession(const RingSessionWish& wish);

  [[nodiscard]] MergeSide side() { return {storage_.stored, storage_, RingRun::lidar_mount()}; }
  /// Of all cells, as the tiles of the run have them.
  [[nodiscard]] KnownMap known_map() const;
  [[nodiscard]] MemoryStorage& storage() { return storage_; }
  /// True pose in the world of a key scan of this session.
  [[nodiscard]] Eigen::Isometry3d truth(const KeyScan& key) const;

 private:
  RingSessionWish wish_;
  MemoryStorage storage_;
  std::unique_ptr<LocalMap> map_;
};

}  // namespace isobar::test
