// SPDX-License-Identifier: BSD-3-Clause
// Association of an estimate's poses with the reference, and alignment of the two.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "run/evaluation/trajectory.hpp"

namespace isobar::evaluation {

/// Pose of the estimate and of the reference at the same time.
struct PosePair {
  std::int64_t stamp_ns = 0;
  double distance_m = 0.0;  ///< travelled by the reference since its start
  /// The denser trajectory of the two is interpolated: position linearly, attitude by slerp; its stamp is that
  /// of its nearest pose.
  StampedPose reference;
  StampedPose estimate;
};

/// Longest gap of a trajectory that counts as none [s]: `wanted_s` if given; else kUsualGapS, or 1.5 of the
/// trajectory's typical intervals where it is sparser than that (a total station or GNSS has one pose a second).
double bridged_gap_s(const Trajectory& trajectory, std::optional<double> wanted_s);

/// Five scans at 10 Hz [s].
inline constexpr double kUsualGapS = 0.5;

/// Median interval between two poses [s]; 0 for fewer than two.
double typical_interval_s(const Trajectory& trajectory);

/// True if the estimate is the one to interpolate: the reference has at most 2/3 of its poses a second.
bool reference_is_sparser(const Trajectory& reference, const Trajectory& estimate);

/// Pairs each pose of the sparser trajectory that lies within the other's time span with the other one,
/// interpolated at its stamp. Poses in a gap of the other longer than bridged_gap_s() are left out.
std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate,
                                std::optional<double> max_gap_s = std::nullopt);

/// Share 0 … 1 of the reference's time span covered by the estimate: time between two poses no further apart
/// than bridged_gap_s(), and time before the first and after the last pose if not longer than that.
double coverage(const Trajectory& reference, const Trajectory& estimate,
                std::optional<double> max_gap_s = std::nullopt);

/// Alignment of an estimate with the reference. Both must be gravity-aligned, except for kRigid.
enum class Alignment {
  kStart,           ///< equal x, y, z and yaw at the first common pose: shows the drift from there
  kStartOfPath,     ///< equal x, y, z there, yaw as kYawTranslation: for a reference without attitude
  kYawTranslation,  ///< least-squares x, y, z and yaw (Umeyama 1991, about z only)
  kRigid,           ///< least-squares rotation and translation (Umeyama 1991): hides tilt, compares shapes
};

/// True if the reference has positions only: its attitude stands still while its path bends, and the estimate turns,
/// by more than half a radian.
bool lacks_attitude(const std::vector<PosePair>& pairs);

/// T_reference_estimate of the pairs. Identity if there are none.
Eigen::Isometry3d alignment_transform(const std::vector<PosePair>& pairs, Alignment alignment);

/// Replaces each pair's estimate by `transform` times it.
void apply_transform(std::vector<PosePair>& pairs, const Eigen::Isometry3d& transform);

}  // namespace isobar::evaluation
