// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/association.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"

namespace isobar::evaluation {

namespace {

// Typical intervals that are no gap: a sensor that misses its time a little loses nothing.
constexpr double kGapIntervals = 1.5;

// Ratio of the intervals from which on the estimate is interpolated: equal rates with jitter stay below it.
constexpr double kSparserRatio = 1.5;

/// A trajectory at ascending stamps, between its poses.
class Interpolation {
 public:
  Interpolation(const Trajectory& trajectory, double max_gap_s)
      : poses_(trajectory.poses), max_gap_s_(max_gap_s) {}

  /// False outside the trajectory's time and in a gap longer than `max_gap_s`.
  bool move_to(std::int64_t stamp_ns) {
    while (after_ < poses_.size() && poses_[after_].stamp_ns < stamp_ns) ++after_;
    if (after_ == poses_.size()) return false;
    fraction_ = 1.0;
    if (poses_[after_].stamp_ns == stamp_ns) return true;
    if (after_ == 0) return false;
    const std::int64_t before_ns = poses_[after_ - 1].stamp_ns;
    const double gap_s = seconds_between(before_ns, poses_[after_].stamp_ns);
    fraction_ = seconds_between(before_ns, stamp_ns) / gap_s;
    return gap_s <= max_gap_s_;
  }

  [[nodiscard]] StampedPose pose() const {
    const StampedPose& b = poses_[after_];
    if (fraction_ == 1.0) return b;
    const StampedPose& a = poses_[after_ - 1];
    return {(fraction_ < 0.5 ? a : b).stamp_ns, a.position_m + fraction_ * (b.position_m - a.position_m),
            a.attitude.slerp(fraction_, b.attitude)};
  }

  /// Of a quantity that is known at each pose.
  [[nodiscard]] double value_of(const std::vector<double>& values) const {
    if (fraction_ == 1.0) return values[after_];
    return values[after_ - 1] + fraction_ * (values[after_] - values[after_ - 1]);
  }

 private:
  const std::vector<StampedPose>& poses_;
  double max_gap_s_;
  std::size_t after_ = 0;  ///< index of the first pose at or after the stamp
  double fraction_ = 1.0;  ///< of the way from the pose before it
};

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

/// Of the attitude of one side since the first pair.
double largest_turn_rad(const std::vector<PosePair>& pairs, StampedPose PosePair::*side) {
  double largest = 0.0;
  for (const PosePair& pair : pairs) {
    largest = std::max(largest, (pairs.front().*side).attitude.angularDistance((pair.*side).attitude));
  }
  return largest;
}

/// Of the horizontal direction of the reference's path since its first steps of a metre.
double largest_bend_rad(const std::vector<PosePair>& pairs) {
  constexpr double kStepM = 1.0;
  std::optional<double> first_rad;
  double largest = 0.0;
  Eigen::Vector3d corner_m = pairs.front().reference.position_m;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d step_m = pair.reference.position_m - corner_m;
    if (step_m.head<2>().norm() < kStepM) continue;
    const double direction_rad = std::atan2(step_m.y(), step_m.x());
    if (!first_rad) first_rad = direction_rad;
    largest = std::max(largest, std::abs(wrap_angle_rad(direction_rad - *first_rad)));
    corner_m = pair.reference.position_m;
  }
  return largest;
}

/// The same turn, with both at one place at the first common pose.
Eigen::Isometry3d moved_to_start(Eigen::Isometry3d transform, const PosePair& first) {
  transform.translation() = first.reference.position_m - transform.linear() * first.estimate.position_m;
  return transform;
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

double typical_interval_s(const Trajectory& trajectory) {
  const std::vector<StampedPose>& poses = trajectory.poses;
  if (poses.size() < 2) return 0.0;
  std::vector<double> intervals_s;
  intervals_s.reserve(poses.size() - 1);
  for (std::size_t i = 1; i < poses.size(); ++i)
    intervals_s.push_back(seconds_between(poses[i - 1].stamp_ns, poses[i].stamp_ns));
  const auto middle = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 2);
  std::nth_element(intervals_s.begin(), middle, intervals_s.end());
  return *middle;
}

double bridged_gap_s(const Trajectory& trajectory, std::optional<double> wanted_s) {
  return wanted_s ? *wanted_s : std::max(kUsualGapS, kGapIntervals * typical_interval_s(trajectory));
}

bool reference_is_sparser(const Trajectory& reference, const Trajectory& estimate) {
  return typical_interval_s(reference) > kSparserRatio * typical_interval_s(estimate);
}

std::vector<PosePair> associate(const Trajectory& reference, const Trajectory& estimate,
                                std::optional<double> max_gap_s) {
  const std::vector<double> distance_m = travelled_distance_m(reference.poses);
  std::vector<PosePair> pairs;
  if (reference_is_sparser(reference, estimate)) {
    Interpolation at(estimate, bridged_gap_s(estimate, max_gap_s));
    pairs.reserve(reference.poses.size());
    for (std::size_t i = 0; i < reference.poses.size(); ++i) {
      const StampedPose& pose = reference.poses[i];
      if (at.move_to(pose.stamp_ns)) pairs.push_back({pose.stamp_ns, distance_m[i], pose, at.pose()});
    }
    return pairs;
  }
  Interpolation at(reference, bridged_gap_s(reference, max_gap_s));
  pairs.reserve(estimate.poses.size());
  for (const StampedPose& pose : estimate.poses) {
    if (at.move_to(pose.stamp_ns)) pairs.push_back({pose.stamp_ns, at.value_of(distance_m), at.pose(), pose});
  }
  return pairs;
}

double coverage(const Trajectory& reference, const Trajectory& estimate, std::optional<double> max_gap_s) {
  if (reference.empty() || estimate.empty()) return 0.0;
  const double longest_s = bridged_gap_s(estimate, max_gap_s);
  const std::int64_t begin_ns = reference.poses.front().stamp_ns;
  const std::int64_t end_ns = reference.poses.back().stamp_ns;
  if (begin_ns == end_ns) return 1.0;
  double covered_s = 0.0;
  std::int64_t previous_ns = begin_ns;
  for (const StampedPose& pose : estimate.poses) {
    const std::int64_t stamp_ns = std::clamp(pose.stamp_ns, begin_ns, end_ns);
    const double gap_s = seconds_between(previous_ns, stamp_ns);
    if (gap_s <= longest_s) covered_s += gap_s;
    previous_ns = stamp_ns;
  }
  const double rest_s = seconds_between(previous_ns, end_ns);
  if (rest_s <= longest_s) covered_s += rest_s;
  return covered_s / seconds_between(begin_ns, end_ns);
}

bool lacks_attitude(const std::vector<PosePair>& pairs) {
  constexpr double kStillRad = 1e-6;
  constexpr double kTurnedRad = 0.5;
  return !pairs.empty() && largest_turn_rad(pairs, &PosePair::reference) < kStillRad &&
         largest_turn_rad(pairs, &PosePair::estimate) > kTurnedRad && largest_bend_rad(pairs) > kTurnedRad;
}

Eigen::Isometry3d alignment_transform(const std::vector<PosePair>& pairs, Alignment alignment) {
  if (pairs.empty()) return Eigen::Isometry3d::Identity();
  switch (alignment) {
    case Alignment::kStart:
      return start_alignment(pairs.front());
    case Alignment::kStartOfPath:
      return moved_to_start(yaw_umeyama(pairs), pairs.front());
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
