// SPDX-License-Identifier: BSD-3-Clause
// A submap that was forgotten, made anew from the key scans that the storage keeps.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>

#include "core/loops/building_storage.hpp"
#include "core/loops/loop_config.hpp"
#include "core/loops/submap.hpp"
#include "core/map/map_config.hpp"
#include "core/map/map_snapshot.hpp"

namespace isobar {

/// Makes the planes of submaps. One thread.
class SubmapMaker {
 public:
  /// `storage` outlives the maker.
  SubmapMaker(const MapConfig& map, const Eigen::Isometry3d& T_base_lidar, BuildingStorage& storage);

  /// Planes of `submaps[number]`, from the key scans that it holds and those before, while it grew beside the submap that
  /// held them. Key scans that cannot be read are left out; null where there is none.
  [[nodiscard]] std::shared_ptr<const MapSnapshot> planes_of(std::span<const Submap> submaps,
                                                             std::size_t number);
  /// Reads the samples of key scans that lack one, SubmapConfig::loop_spacing_m apart: the test of a loop by free space
  /// needs them.
  void restore_samples(Submap& submap, const SubmapConfig& config);

 private:
  MapConfig map_;
  Eigen::Isometry3d T_base_lidar_;
  BuildingStorage& storage_;
  std::unique_ptr<RegisteredScan> scan_;
};

}  // namespace isobar
