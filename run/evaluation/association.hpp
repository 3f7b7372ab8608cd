// SPDX-License-Identifier: BSD-3-Clause
// Which pose of the estimate belongs to which pose of the reference, and how they are laid over each other.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "run/evaluation/trajectory.hpp"

namespace isobar::evaluation {

/// An estimate's pose and the reference at the same instant.
struct PosePair {
  std::int64_t stamp_ns = 0;
  double distance_m = 0.0;  ///< travelled by the reference since its start
  StampedPose reference;    ///< interpolated: position linearly, attitude by slerp
  StampedPose estimate;
};

/// Pairs every pose of the estimate that lies within the reference's time with the reference interpolated at
/// its stamp. Poses that fall into a hole of the reference longer than `max_gap_s` are left out.
std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate, double max_gap_s);

/// Share 0 … 1 of the reference's time span that lies between two poses of the estimate less than `max_gap_s`
/// apart. The time before the first and after the last pose counts as covered if it is shorter than that.
double coverage(const Trajectory& reference, const Trajectory& estimate, double max_gap_s);

/// How an estimate is moved onto the reference. Both must be gravity-aligned but for kRigid.
enum class Alignment {
  kStart,           ///< x, y, z and yaw made equal at the first common pose: what the drift is measured from
  kYawTranslation,  ///< x, y, z and yaw that minimise the sum of squared distances (Umeyama 1991, about z
                    ///< only)
  kRigid,  ///< rotation and translation that do so (Umeyama 1991): hides tilt, use it to compare shapes
};

/// T_reference_estimate of the pairs. Identity if there are none.
Eigen::Isometry3d alignment_transform(const std::vector<PosePair>& pairs, Alignment alignment);

/// Replaces each pair's estimate by `transform` times it.
void apply_transform(std::vector<PosePair>& pairs, const Eigen::Isometry3d& transform);

}  // namespace isobar::evaluation
