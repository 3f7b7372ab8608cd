// SPDX-License-Identifier: BSD-3-Clause
// Removal of moved objects: finds the cells that rays now pass through (a door opened, a person left).
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/map/free_space.hpp"
#include "core/map/grid.hpp"
#include "core/map/map_block.hpp"
#include "core/map/map_config.hpp"

namespace isobar {

/// Counts per cell of the map the scans whose rays pass through it (MapCell::seen_through). Scans that follow
/// each other closely are redundant: each tests a part of the blocks, in turn.
class SeenThrough {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link; rays start there.
  SeenThrough(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar);

  /// Sets the scan whose rays are used. `elapsed_s`: time since the previous scan.
  void set_scan(const RegisteredScan& scan, double elapsed_s);

  /// True if cells of the tile may be within range of the test.
  [[nodiscard]] bool reaches(const TileKey& key) const;

  /// Counts for the cells of block `index` (0 … 63) of tile `key`, if it is in range and its turn. Returns
  /// true if the count of a cell exceeds MapConfig::see_through_limit.
  bool count(const TileKey& key, std::size_t index, MapBlock& block) const;

 private:
  bool count_cells(const Eigen::Vector3f& centre_local, MapBlock& block) const;
  bool count_batch(const FreeSpace::Points& p_lidar, std::size_t first, std::size_t count,
                   MapBlock& block) const;

  float cell_m_;
  float reach_m_;
  float margin_m_;
  std::uint8_t limit_;
  Eigen::Isometry3d T_lidar_base_;

  FreeSpace free_space_;
  LocalFrame frame_;
  Eigen::Vector3d p_map_base_ = Eigen::Vector3d::Zero();
  Eigen::Vector3f p_local_lidar_ = Eigen::Vector3f::Zero();
  Eigen::Isometry3f T_lidar_local_ = Eigen::Isometry3f::Identity();
  std::uint64_t scan_count_ = 0;
  std::size_t decimation_ = 1;  // this scan tests every decimation_-th block
};

}  // namespace isobar
