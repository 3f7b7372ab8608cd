// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/submap_maker.hpp"

#include "core/map/local_map.hpp"

namespace isobar {

SubmapMaker::SubmapMaker(const MapConfig& map, const Eigen::Isometry3d& T_base_lidar,
                         BuildingStorage& storage)
    : map_(map), T_base_lidar_(T_base_lidar), storage_(storage), scan_(std::make_unique<RegisteredScan>()) {}

std::shared_ptr<const MapSnapshot> SubmapMaker::planes_of(std::span<const Submap> submaps,
                                                          std::size_t number) {
  LocalMap map(map_, T_base_lidar_);
  const auto add = [&](const KeyScan& key, const Eigen::Isometry3d& T_submap_base) {
    if (key.scan == kNoScanHandle || !storage_.read_scan(key.scan, *scan_)) return;
    scan_->pose.session = map.session();
    scan_->pose.T_map_base = T_submap_base;
    map.update(*scan_);
  };
  const Submap& submap = submaps[number];
  if (number > 0) {
    const Eigen::Isometry3d T_submap_before = submap.link.T_before_submap.inverse();
    for (const KeyScan& key : submaps[number - 1].keys) {
      if (key.way_m >= submap.first_way_m) add(key, T_submap_before * key.T_submap_base);
    }
  }
  for (const KeyScan& key : submap.keys) add(key, key.T_submap_base);
  return map.snapshot()->empty() ? nullptr : map.snapshot();
}

void SubmapMaker::restore_samples(Submap& submap, const SubmapConfig& config) {
  double sampled_way_m = submap.first_way_m - config.loop_spacing_m;
  for (KeyScan& key : submap.keys) {
    if (key.way_m - sampled_way_m < config.loop_spacing_m) continue;
    sampled_way_m = key.way_m;
    if (!key.p_base.empty() || key.scan == kNoScanHandle || !storage_.read_scan(key.scan, *scan_)) continue;
    take_sample(*scan_, config.sample_points, key.p_base);
  }
}

}  // namespace isobar
