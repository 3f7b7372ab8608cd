// SPDX-License-Identifier: BSD-3-Clause
// Merge of two map folders into a third one: places, loops and poses by core/merge, the map laid anew from the scans of both.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/merge/building_merger.hpp"

namespace isobar::files {

/// A map folder that is merged; it is only read, and may be being written.
struct MergeInput {
  std::filesystem::path map_folder;
  Eigen::Isometry3d T_base_lidar = Eigen::Isometry3d::Identity();
};

/// What is merged, and where to.
struct MergeRequest {
  MergeInput a;
  MergeInput b;
  std::filesystem::path out;  ///< becomes the folder of a run with the map; new, or empty
  MergeSettings settings;     ///< the cells' edge is taken from the map of A
  HeightRelation height;
};

/// Outcome of a merge.
struct MergeReport {
  MergeFigures figures;
  std::string problem;             ///< why B does not fit; empty: `out` has been written
  std::vector<std::string> notes;  ///< what of A and B is missing, in words
  std::size_t submaps_a = 0;
  std::size_t submaps_b = 0;
  std::size_t keys = 0;          ///< key scans that were laid
  std::size_t missing_keys = 0;  ///< key scans whose points cannot be read
  std::size_t tiles = 0;         ///< of the result
  std::uint64_t gone = 0;        ///< cells of A that B saw through
  std::int64_t b_later_ns = 0;   ///< see JoinedBuildings
  MapConfig map;                 ///< with which the result was laid
};

/// Merges B into A. `progress`: share that is done, 0 … 1.
/// @throws UsageError where A and B are one map, or `out` is not empty
/// @throws DataError where a folder holds no map, or no building
/// @throws ServiceError when the disk refuses; `out` is then as before
[[nodiscard]] MergeReport merge_maps(const MergeRequest& request,
                                     const std::function<void(double)>& progress);

}  // namespace isobar::files
