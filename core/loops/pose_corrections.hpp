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
};

/// Corrects any pose of the run: by the key scan before it and the one after it, in proportion to the time. Before the
/// first and after the last one their correction holds.
class PoseCorrections {
 public:
  /// `keys`: in any order.
  explicit PoseCorrections(std::vector<CorrectedKey> keys);

  /// The corrected pose of a live pose at `stamp_ns`.
  [[nodiscard]] Eigen::Isometry3d corrected(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) const;

 private:
  std::vector<CorrectedKey> keys_;  // in order of time
};

}  // namespace isobar
