// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/association.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"

namespace isobar::evaluation {

namespace {

StampedPose interpolated(const StampedPose& a, const StampedPose& b, double fraction, std::int64_t stamp_ns) {
  return {stamp_ns, a.position_m + fraction * (b.position_m - a.position_m),
          a.attitude.slerp(fraction, b.attitude)};
}

Eigen::Isometry3d yaw_and_translation(double yaw, const Eigen::Vector3d& from_m,
                                      const Eigen::Vector3d& to_m) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  transform.translation() = to_m - transform.linear() * from_m;
  return transform;
}

Eigen::Isometry3d start_alignment(const PosePair& first) {
  // Rotation about z closest to R = C_reference C_estimate^T: independent of roll and pitch.
  const Eigen::Quaterniond rotation = first.reference.attitude * first.estimate.attitude.conjugate();
  return yaw_and_translation(2.0 * std::atan2(rotation.z(), rotation.w()), first.estimate.position_m,
                             first.reference.position_m);
}

Eigen::Isometry3d yaw_umeyama(const std::vector<PosePair>& pairs) {
  Eigen::Vector3d mean_reference_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_estimate_m = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) {
    mean_reference_m += pair.reference.position_m / static_cast<double>(pairs.size());
    mean_estimate_m += pair.estimate.position_m / static_cast<double>(pairs.size());
  }
  double cosine = 0.0;
  double sine = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d r = pair.reference.position_m - mean_reference_m;
    const Eigen::Vector3d e = pair.estimate.position_m - mean_estimate_m;
    cosine += e.x() * r.x() + e.y() * r.y();
    sine += e.x() * r.y() - e.y() * r.x();
  }
  return yaw_and_translation(std::atan2(sine, cosine), mean_estimate_m, mean_reference_m);
}

Eigen::Isometry3d rigid_umeyama(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(pairs.size()));
  Eigen::Matrix3Xd to(3, static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].estimate.position_m;
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].reference.position_m;
  }
  Eigen::Isometry3d transform;
  transform.matrix() = Eigen::umeyama(from, to, false);
  return transform;
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate, double max_gap_s) {
  const std::vector<double> distance_m = travelled_distance_m(reference.poses);
  std::vector<PosePair> pairs;
  pairs.reserve(estimate.poses.size());
  std::size_t after = 0;  // index of the first reference pose at or after the stamp
  for (const StampedPose& pose : estimate.poses) {
    while (after < reference.poses.size() && reference.poses[after].stamp_ns < pose.stamp_ns) ++after;
    if (after == reference.poses.size()) break;
    const StampedPose& b = reference.poses[after];
    if (b.stamp_ns == pose.stamp_ns) {
      pairs.push_back({pose.stamp_ns, distance_m[after], b, pose});
      continue;
    }
    if (after == 0) continue;
    const StampedPose& a = reference.poses[after - 1];
    const double gap_s = seconds_between(a.stamp_ns, b.stamp_ns);
    if (gap_s > max_gap_s) continue;
    const double fraction = seconds_between(a.stamp_ns, pose.stamp_ns) / gap_s;
    const double at_m = distance_m[after - 1] + fraction * (distance_m[after] - distance_m[after - 1]);
    pairs.push_back({pose.stamp_ns, at_m, interpolated(a, b, fraction, pose.stamp_ns), pose});
  }
  return pairs;
}

double coverage(const Trajectory& reference, const Trajectory& estimate, double max_gap_s) {
  if (reference.empty() || estimate.empty()) return 0.0;
  const std::int64_t begin_ns = reference.poses.front().stamp_ns;
  const std::int64_t end_ns = reference.poses.back().stamp_ns;
  if (begin_ns == end_ns) return 1.0;
  double covered_s = 0.0;
  std::int64_t previous_ns = begin_ns;
  for (const StampedPose& pose : estimate.poses) {
    const std::int64_t stamp_ns = std::clamp(pose.stamp_ns, begin_ns, end_ns);
    const double gap_s = seconds_between(previous_ns, stamp_ns);
    if (gap_s < max_gap_s) covered_s += gap_s;
    previous_ns = stamp_ns;
  }
  const double rest_s = seconds_between(previous_ns, end_ns);
  if (rest_s < max_gap_s) covered_s += rest_s;
  return covered_s / seconds_between(begin_ns, end_ns);
}

Eigen::Isometry3d alignment_transform(const std::vector<PosePair>& pairs, Alignment alignment) {
  if (pairs.empty()) return Eigen::Isometry3d::Identity();
  switch (alignment) {
    case Alignment::kStart:
      return start_alignment(pairs.front());
    case Alignment::kYawTranslation:
      return yaw_umeyama(pairs);
    case Alignment::kRigid:
      return rigid_umeyama(pairs);
  }
  return Eigen::Isometry3d::Identity();
}

void apply_transform(std::vector<PosePair>& pairs, const Eigen::Isometry3d& transform) {
  const Eigen::Quaterniond rotation(transform.linear());
  for (PosePair& pair : pairs) {
    pair.estimate.position_m = transform * pair.estimate.position_m;
    pair.estimate.attitude = (rotation * pair.estimate.attitude).normalized();
  }
}

}  // namespace isobar::evaluation
