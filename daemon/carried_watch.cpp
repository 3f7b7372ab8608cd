// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/carried_watch.hpp"

#include <cmath>

#include "core/stamp.hpp"

namespace isobar {

namespace {

// As core/registration/hint_trial.cpp: overlap of the first scan of another place, in shares of the usual one.
constexpr double kFallenShare = 0.6;
constexpr double kGain = 0.05;
// A place that matches so badly is not known: nothing can fall there.
constexpr double kLeastUsual = 0.5;
// Wheels that stand, and for how long.
constexpr double kStandMS = 0.02;
constexpr double kStandRadS = 0.03;
constexpr double kStoodS = 1.0;

}  // namespace

bool CarriedWatch::add(const PoseEstimate& pose, const Prior& prior) {
  const bool turns = std::abs(prior.v_base_m_s.x()) > kStandMS || std::abs(prior.v_base_m_s.y()) > kStandMS ||
                     (prior.may_stand && std::abs(prior.w_base_rad_s.z()) > kStandRadS);
  if (!prior.velocity_valid || turns || drove_ns_ == 0) drove_ns_ = pose.stamp_ns;
  const bool stands = seconds_between(drove_ns_, pose.stamp_ns) >= kStoodS && !prior.ground_moves;
  const bool known = usual_overlap_ >= kLeastUsual;
  const double overlap = pose.mode == PoseMode::kRegistered ? pose.overlap : 0.0;
  const bool falls = stands && known && pose.sampled_points > 0 && overlap < kFallenShare * usual_overlap_;
  if (pose.mode == PoseMode::kRegistered) {
    usual_overlap_ += (usual_overlap_ > 0.0 ? kGain : 1.0) * (overlap - usual_overlap_);
  }
  return falls;
}

}  // namespace isobar
