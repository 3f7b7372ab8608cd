// SPDX-License-Identifier: BSD-3-Clause
// Association of an estimate's poses with the reference, and alignment of the two.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "run/evaluation/trajectory.hpp"

namespace isobar::evaluation {

/// Pose of the estimate and of the reference at the same time.
struct PosePair {
  std::int64_t stamp_ns = 0;
  double distance_m = 0.0;  ///< travelled by the reference since its start
  StampedPose reference;    ///< interpolated: position linearly, attitude by slerp
  StampedPose estimate;
};

/// Pairs each pose of the estimate within the reference's time span with the reference interpolated at its
/// stamp. Poses in a gap of the reference longer than `max_gap_s` are left out.
std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate, double max_gap_s);

/// Share 0 … 1 of the reference's time span covered by the estimate: time between two poses less than
/// `max_gap_s` apart, and time before the first and after the last pose if shorter than that.
double coverage(const Trajectory& reference, const Trajectory& estimate, double max_gap_s);

/// Alignment of an estimate with the reference. Both must be gravity-aligned, except for kRigid.
enum class Alignment {
  kStart,           ///< equal x, y, z and yaw at the first common pose: shows the drift from there
  kYawTranslation,  ///< least-squares x, y, z and yaw (Umeyama 1991, about z only)
  kRigid,           ///< least-squares rotation and translation (Umeyama 1991): hides tilt, compares shapes
};

/// T_reference_estimate of the pairs. Identity if there are none.
Eigen::Isometry3d alignment_transform(const std::vector<PosePair>& pairs, Alignment alignment);

/// Replaces each pair's estimate by `transform` times it.
void apply_transform(std::vector<PosePair>& pairs, const Eigen::Isometry3d& transform);

}  // namespace isobar::evaluation
