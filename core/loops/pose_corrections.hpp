// SPDX-License-Identifier: BSD-3-Clause
// Corrections of the poses of a run, between its key scans.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <utility>
#include <vector>

namespace isobar {

/// Correction of the live pose at a key scan.
struct CorrectedKey {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();            ///< as estimated live
  Eigen::Isometry3d T_map_base_corrected = Eigen::Isometry3d::Identity();  ///< after the loops
  std::uint32_t map_moves = 0;                                             ///< of T_map_base, see MapMove
};

/// Corrects any pose of the run: by the key scan before it and the one after it, in proportion to the time. Before the
/// first and after the last one their correction holds. Where the map was moved between the two, live poses jump: before
/// the jump the first one's correction holds, after it the other's.
class PoseCorrections {
 public:
  /// `keys`: in any order. `moved_ns`: stamps of the first live poses in a moved map, ascending.
  explicit PoseCorrections(std::vector<CorrectedKey> keys, std::vector<std::int64_t> moved_ns = {});

  /// The corrected pose of a live pose at `stamp_ns`.
  [[nodiscard]] Eigen::Isometry3d corrected(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) const;

 private:
  std::vector<CorrectedKey> keys_;  // in order of time
  std::vector<std::int64_t> moved_ns_;
};

}  // namespace isobar
