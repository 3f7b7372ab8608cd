// SPDX-License-Identifier: BSD-3-Clause
// The part of PlaceStage for a robot that may have been carried away.
#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/loops/submap.hpp"
#include "core/so3.hpp"
#include "daemon/place_frames.hpp"
#include "daemon/place_stage.hpp"

namespace isobar {

namespace {

// Distance up to which a place is the present one, and up to which two looks have found one place; searches before the robot
// is taken to be where it was.
constexpr double kPresentM = 1.5;
constexpr double kSameM = 0.3;
constexpr double kNearRad = 15.0 * kRadPerDeg;
constexpr int kMostLooks = 4;
// Right places of second sessions fit to 0.88 … 0.97; on another floor of an elevator's shaft others fitted to 0.81.
constexpr double kLeastCarriedFit = 0.85;

bool are_near(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double apart_m) {
  return (a.translation() - b.translation()).norm() < apart_m &&
         std::abs(yaw_of(a.linear().transpose() * b.linear())) < kNearRad;
}

}  // namespace

// Of a robot that knows its place.
void PlaceStage::watch(const PoseEstimate& pose) {
  carried_ = read_map_ && carried_watch_.add(pose, prior_);
  if (carried_ || pose.mode != PoseMode::kRegistered || prior_.height_source == HeightSource::kNone) return;
  last_z_m_ = pose.T_map_base.translation().z();
  z_above_height_m_ = last_z_m_ - prior_.height_m;
  height_is_of_map_ = true;
}

bool PlaceStage::is_at_found_place(const PoseEstimate& pose) const {
  return seen_at_ && are_near(*seen_at_ * upright(odometry_of(pose)), upright(pose.T_map_base), kPresentM);
}

// Two looks, a metre apart, must find one and the same other place, in a map that knows nothing of where the robot believes
// to be. If that fits as well, something else has changed.
void PlaceStage::take_carried(const ColdStartResult& result, const PoseEstimate& pose) {
  const Eigen::Isometry3d T_present = upright(pose.T_map_base);
  const bool present_fits =
      std::any_of(result.candidates.begin(), result.candidates.end(),
                  [&](const PlaceCandidate& one) { return are_near(one.T_map_level, T_present, kPresentM); });
  if (present_fits || ++looks_ > kMostLooks) return end_search();
  if (result.verdict != ColdStartVerdict::kFound || status_.fit < kLeastCarriedFit) return seen_at_.reset();
  const Eigen::Isometry3d T_map_odom =
      result.candidates.front().T_map_level * T_odom_asked_.inverse(Eigen::Isometry);
  if (seen_at_ && are_near(*seen_at_ * T_odom_asked_, T_map_odom * T_odom_asked_, kSameM)) {
    tell(T_map_odom, pose.stamp_ns);
  }
  seen_at_ = T_map_odom;
}

}  // namespace isobar
