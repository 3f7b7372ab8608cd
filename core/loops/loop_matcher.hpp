// SPDX-License-Identifier: BSD-3-Clause
// Match of a key scan to a submap of an earlier visit, and the tests that a right match passes.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "core/loops/loop.hpp"
#include "core/loops/submap.hpp"
#include "core/map/free_space.hpp"
#include "core/registration/method.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/scan_matcher.hpp"

namespace isobar {

/// What a right match looks like.
struct LoopCriteria {
  double min_overlap = 0.6;        ///< share of the sample that lies on planes of the submap
  double max_residual_m = 0.06;    ///< rms to these planes
  double max_contradiction = 0.1;  ///< share of the submap's points through which rays of the key scan passed
  double height_sigmas = 3.0;      ///< z against what the altimeter allows
};

/// Where the key scan is expected in the submap.
struct LoopGuess {
  Eigen::Isometry3d T_submap_base = Eigen::Isometry3d::Identity();
  double level_sigma_m = 0.1;   ///< of x and of y
  double height_sigma_m = 0.1;  ///< of z: the altimeter's, or better
  double yaw_sigma_rad = 0.01;
};

/// Matches key scans to submaps. One thread.
class LoopMatcher {
 public:
  /// `spacing_m`: largest distance between neighbouring points of scans, see FreeSpace.
  LoopMatcher(const LoopCriteria& criteria, const RegistrationConfig& registration, std::size_t sample_points,
              float spacing_m, const Eigen::Isometry3d& T_base_lidar);

  /// The scan of the key scan, for its free space. Before match().
  void set_scan(const RegisteredScan& scan) { free_space_.set_scan(scan, T_lidar_base_); }
  /// Matches `key`, expected at `guess`, to `submap`, which is complete.
  /// @return pose, covariance and quality; nothing where a criterion fails
  [[nodiscard]] std::optional<Loop> match(const Submap& submap, const KeyScan& key, const LoopGuess& guess);

 private:
  [[nodiscard]] MatchResult best_match(const Submap& submap, const KeyScan& key, const LoopGuess& guess);
  [[nodiscard]] bool acceptable(const MatchResult& result, const LoopGuess& guess) const;
  [[nodiscard]] double contradiction(const Submap& submap, const Eigen::Isometry3d& T_submap_base) const;

  LoopCriteria criteria_;
  Eigen::Isometry3d T_lidar_base_;
  MethodTraits traits_;
  ScanMatcher matcher_;
  FreeSpace free_space_;
};

}  // namespace isobar
