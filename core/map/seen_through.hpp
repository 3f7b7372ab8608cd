// SPDX-License-Identifier: BSD-3-Clause
// What rays have passed through: doors that opened, people that walked on. Their cells must go.
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

/// Counts for the cells of the map the rays of scans that passed them. Of scans that follow each other
/// closely each looks at a part of the map only, since their rays say nearly the same.
class SeenThrough {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link; rays start there.
  SeenThrough(const MapConfig& config, const Eigen::Isometry3d& T_base_lidar);

  /// Takes the rays of a scan, `elapsed_s` after the one before.
  void set_scan(const RegisteredScan& scan, double elapsed_s);

  /// False where no cell of a tile is near enough to be looked at.
  [[nodiscard]] bool reaches(const TileKey& key) const;

  /// Counts for block `index` of tile `key`, if it is near and its turn. True if one of its cells has been
  /// seen through more often than the configuration allows.
  bool count(const TileKey& key, std::size_t index, MapBlock& block) const;

 private:
  bool count_cells(const Eigen::Vector3f& centre_local, MapBlock& block) const;
  bool count_up_to_64(const FreeSpace::Points& p_lidar, std::size_t first, std::size_t count,
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
  std::uint64_t looks_ = 0;
  std::size_t parts_ = 1;
};

}  // namespace isobar
