// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/pose_propagator.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/method.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Upper bound of a plausible velocity between two registered poses; more is a relocalisation, not a motion.
constexpr double kMaxSpeedMS = 15.0;
// Longest time between two scans over which their velocity is constant enough.
constexpr double kMaxScanGapS = 0.5;
// A pose up to this much newer than the last prior uses that prior's height.
constexpr double kMaxHeightAgeS = 0.1;

bool is_finite(const Prior& prior) {
  return prior.T_odom_base.matrix().allFinite() && std::isfinite(prior.height_m) &&
         prior.v_base_m_s.allFinite() && prior.w_base_rad_s.allFinite();
}

bool is_finite(const PoseEstimate& pose) {
  return pose.T_map_base.matrix().allFinite() && pose.T_map_odom.matrix().allFinite() &&
         pose.covariance.allFinite();
}

// The others follow it only on moving ground, where the scans stay out of the map.
bool height_from_altimeter(const PoseEstimate& pose) {
  const MethodTraits traits = traits_of(pose.effective_method, pose.height_source);
  const bool rides = traits.method == Method::kAdaptive && !pose.for_map && pose.lost == LostReason::kNone;
  return traits.follows_altimeter() || rides || pose.lost == LostReason::kMovingGround;
}

}  // namespace

PosePropagator::PosePropagator(const PosePropagatorConfig& config) : config_(config) {}

void PosePropagator::add_pose(const PoseEstimate& pose) {
  const bool new_session = has_anchor_ && pose.session != anchor_.pose.session;
  if (!is_finite(pose) || (has_anchor_ && !new_session && pose.stamp_ns <= anchor_.pose.stamp_ns)) {
    return;
  }
  if (new_session) begin_session(pose);
  if (has_anchor_ && has_prior_) follow_relocation(pose);
  Anchor next;
  next.pose = pose;
  next.carried = PoseAnchor(pose.T_map_base, pose.T_map_odom.inverse() * pose.T_map_base);
  next.follows_altimeter = height_from_altimeter(pose) && height_at(pose.stamp_ns, next.height_m);
  const bool needs_velocity = has_prior_ && !last_prior_.velocity_valid && !last_prior_.standing_still;
  if (needs_velocity) {
    next.v_map_m_s = registered_velocity(pose);
  }
  anchor_ = next;
  has_anchor_ = true;
}

// The odom frame stays where it is in the world; the new map frame begins at the robot. Its clock may have
// started over.
void PosePropagator::begin_session(const PoseEstimate& first) {
  if (has_odometry_) T_odom_map_ = T_odom_base_ * first.T_map_base.inverse(Eigen::Isometry);
  has_anchor_ = has_prior_ = false;
  height_count_ = 0;
}

// Found elsewhere, by a search or a hint, or taken along by its map: the robot has not driven there. Odom stays, at the time of the pose.
void PosePropagator::follow_relocation(const PoseEstimate& pose) {
  Prior then = last_prior_;
  then.stamp_ns = pose.stamp_ns;
  then.T_odom_base = pose.T_map_odom.inverse(Eigen::Isometry) * pose.T_map_base;
  if (anchor_.follows_altimeter && !height_at(pose.stamp_ns, then.height_m)) return;
  const Eigen::Isometry3d believed = best_pose(then);
  const double distance_m = (pose.T_map_base.translation() - believed.translation()).norm();
  const Eigen::Matrix3d turn = pose.T_map_base.linear() * believed.linear().transpose();
  const bool map_moved = pose.map_moves != anchor_.pose.map_moves;
  if (!map_moved && distance_m < kElsewhereM && Eigen::AngleAxisd(turn).angle() < kElsewhereRad) return;
  T_odom_map_ = T_odom_map_ * believed * pose.T_map_base.inverse(Eigen::Isometry);
}

bool PosePropagator::propagate(const Prior& prior, Odometry& out) {
  if (!is_finite(prior) || (has_prior_ && prior.stamp_ns <= last_prior_.stamp_ns)) {
    return false;
  }
  heights_[height_count_++ % kHeights] = {prior.stamp_ns, prior.height_m};
  if (!has_anchor_) {
    last_prior_ = prior;
    has_prior_ = true;
    return false;
  }
  const Eigen::Isometry3d best = best_pose(prior);
  if (has_odometry_ && has_prior_) {
    // Both ends of the step use the same anchor: a new registration is a correction, not a motion.
    T_odom_base_ = T_odom_base_ * best_pose(last_prior_).inverse(Eigen::Isometry) * best;
    slew_towards(T_odom_map_ * best, seconds_between(last_prior_.stamp_ns, prior.stamp_ns));
  } else {
    T_odom_base_ = T_odom_map_ * best;
    has_odometry_ = true;
  }
  last_prior_ = prior;
  has_prior_ = true;

  out.stamp_ns = prior.stamp_ns;
  out.session = anchor_.pose.session;
  out.T_map_base = best;
  out.T_odom_base = T_odom_base_;
  out.T_map_odom = best * T_odom_base_.inverse(Eigen::Isometry);
  out.age_s = seconds_between(anchor_.pose.stamp_ns, prior.stamp_ns);
  fill_twist(prior, out);
  fill_covariance(prior, out);
  return true;
}

Eigen::Isometry3d PosePropagator::best_pose(const Prior& prior) const {
  Eigen::Isometry3d best = anchor_.carried.carried_to(prior.T_odom_base);
  const double ahead_s =
      std::clamp(seconds_between(anchor_.pose.stamp_ns, prior.stamp_ns), 0.0, config_.max_extrapolation_s);
  best.translation() += anchor_.v_map_m_s * ahead_s;
  if (anchor_.follows_altimeter) {
    // In an elevator only the altimeter measures the motion.
    best.translation().z() = anchor_.pose.T_map_base.translation().z() + prior.height_m - anchor_.height_m;
  }
  return best;
}

bool PosePropagator::height_at(std::int64_t stamp_ns, double& height_m) const {
  const std::size_t available = std::min(height_count_, kHeights);
  if (available == 0) {
    return false;
  }
  const Height& newest = heights_[(height_count_ - 1) % kHeights];
  if (stamp_ns > newest.stamp_ns) {
    height_m = newest.height_m;
    return seconds_between(newest.stamp_ns, stamp_ns) <= kMaxHeightAgeS;
  }
  for (std::size_t back = 1; back < available; ++back) {
    const Height& older = heights_[(height_count_ - 1 - back) % kHeights];
    const Height& newer = heights_[(height_count_ - back) % kHeights];
    if (older.stamp_ns <= stamp_ns && stamp_ns <= newer.stamp_ns) {
      const double part =
          seconds_between(older.stamp_ns, stamp_ns) / seconds_between(older.stamp_ns, newer.stamp_ns);
      height_m = older.height_m + part * (newer.height_m - older.height_m);
      return true;
    }
  }
  return false;
}

Eigen::Vector3d PosePropagator::registered_velocity(const PoseEstimate& pose) const {
  // The step from the last pose is not a motion.
  if (has_anchor_ && pose.map_moves != anchor_.pose.map_moves) return anchor_.v_map_m_s;
  const double gap_s = has_anchor_ ? seconds_between(anchor_.pose.stamp_ns, pose.stamp_ns) : 0.0;
  if (gap_s <= 0.0 || gap_s > kMaxScanGapS || pose.mode != PoseMode::kRegistered ||
      anchor_.pose.mode != PoseMode::kRegistered) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d v_map_m_s =
      (pose.T_map_base.translation() - anchor_.pose.T_map_base.translation()) / gap_s;
  return v_map_m_s.norm() <= kMaxSpeedMS ? v_map_m_s : Eigen::Vector3d::Zero();
}

void PosePropagator::slew_towards(const Eigen::Isometry3d& target, double elapsed_s) {
  const double part = 1.0 - std::exp(-elapsed_s / config_.slew_time_s);

  const Eigen::Vector3d missing_m = target.translation() - T_odom_base_.translation();
  const double distance_m = missing_m.norm();
  if (distance_m > 0.0) {
    const double step_m = std::min(part * distance_m, config_.max_slew_m_s * elapsed_s);
    T_odom_base_.translation() += missing_m * (step_m / distance_m);
  }

  const Eigen::Quaterniond from(T_odom_base_.linear());
  const Eigen::Quaterniond to(target.linear());
  const double angle_rad = from.angularDistance(to);
  double step = part;
  if (angle_rad > 0.0) {
    step = std::min(part, config_.max_slew_rad_s * elapsed_s / angle_rad);
  }
  T_odom_base_.linear() = from.slerp(step, to).normalized().toRotationMatrix();
}

void PosePropagator::fill_twist(const Prior& prior, Odometry& out) const {
  out.v_base_m_s = prior.v_base_m_s;
  if (!prior.velocity_valid && out.age_s <= config_.max_extrapolation_s) {
    out.v_base_m_s = out.T_map_base.linear().transpose() * anchor_.v_map_m_s;
  }
  out.w_base_rad_s = prior.w_base_rad_s;
  out.twist_covariance.setZero();
  out.twist_covariance.diagonal().head<3>().setConstant(prior.velocity_variance_m2_s2);
  out.twist_covariance.diagonal().tail<3>().setConstant(prior.yaw_rate_variance_rad2_s2);
}

void PosePropagator::fill_covariance(const Prior& prior, Odometry& out) const {
  // Covariance of the registration plus dead reckoning's errors since, as constant rates over the age.
  const double age2_s2 = out.age_s * out.age_s;
  out.pose_covariance = anchor_.pose.covariance;
  auto variances = out.pose_covariance.diagonal();
  variances.head<2>().array() += age2_s2 * prior.velocity_variance_m2_s2;
  variances(5) += age2_s2 * prior.yaw_rate_variance_rad2_s2;
  if (anchor_.follows_altimeter) {
    variances(2) = std::max(variances(2), prior.height_variance_m2);
  } else {
    variances(2) += age2_s2 * prior.velocity_variance_m2_s2;
  }
}

}  // namespace isobar
