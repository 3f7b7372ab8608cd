// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/hint_trial.hpp"

#include <algorithm>

#include "core/geometry.hpp"
#include "core/pose_carrying.hpp"

namespace isobar {

namespace {

// Half the extent of the hypotheses, in sigmas and within limits: a person points to within a metre, and beyond five
// there are too many of them.
constexpr double kSigmas = 2.0;
constexpr double kLeastRadiusM = 1.0;
constexpr double kLargestRadiusM = 5.0;
// The same of a hint that states no error.
constexpr double kUnstatedM = 0.5;
constexpr double kUnstatedRad = 15.0 * kRadPerDeg;
// Longest trial: 972 hypotheses, two a scan, take 49 s at 10 Hz.
constexpr std::int64_t kLongestNs = 70'000'000'000;

// Share of the usual overlap below which a scan may be the first one of another place: 0.4 when a robot was carried across a
// room, 0.35 after a corner. For this long a hint need not match better than the present place.
constexpr double kFallenShare = 0.6;
constexpr std::int64_t kDoubtNs = 300'000'000'000;

}  // namespace

void HintTrial::offer(const PlaceHint& hint) {
  search_.stop();
  offered_ = hint;
  ++report_.given;
  report_.outcome = HintOutcome::kTrying;
  report_.radius_m = report_.distance_m = 0.0;
}

void HintTrial::begin(const Prior& now, const Eigen::Isometry3d& T_map_base, double overlap,
                      double residual_rms_m) {
  const double sigma_m = offered_->sigma_m > 0.0 ? offered_->sigma_m : kUnstatedM;
  const double sigma_rad = offered_->sigma_rad > 0.0 ? offered_->sigma_rad : kUnstatedRad;
  report_.radius_m = std::clamp(kSigmas * sigma_m, kLeastRadiusM, kLargestRadiusM);
  report_.stamp_ns = began_ns_ = now.stamp_ns;
  const bool knows_height = now.height_source != HeightSource::kNone || offered_->has_z;
  search_.begin_around({.radius_m = report_.radius_m,
                        .turn_rad = std::min(kSigmas * sigma_rad, kPi),
                        .sigma_m = std::max(sigma_m, kUnstatedM),
                        .overlap = overlap,
                        .residual_rms_m = residual_rms_m,
                        .has_height = knows_height});
  offered_.reset();
  move_to(now, T_map_base);
}

void HintTrial::finish(HintOutcome outcome, std::int64_t stamp_ns) {
  search_.stop();
  offered_.reset();
  report_.outcome = outcome;
  report_.stamp_ns = stamp_ns;
  if (outcome != HintOutcome::kFound) return;
  ++relocations_;
  fell_ns_ = 0;
}

void HintTrial::watch(std::int64_t stamp_ns, double overlap, double usual_overlap) {
  if (overlap < kFallenShare * usual_overlap) fell_ns_ = stamp_ns;
}

bool HintTrial::present_is_doubtful(std::int64_t now_ns) const {
  return fell_ns_ != 0 && now_ns - fell_ns_ < kDoubtNs;
}

bool HintTrial::is_overdue(std::int64_t now_ns) const { return active() && now_ns - began_ns_ > kLongestNs; }

Eigen::Isometry3d HintTrial::expected(const Prior& now) const {
  Eigen::Isometry3d T_map_base = PoseAnchor(T_map_base_, T_odom_base_).carried_to(now.T_odom_base);
  if (has_height_ && now.height_source != HeightSource::kNone) {
    T_map_base.translation().z() = T_map_base_.translation().z() + now.height_m - height_m_;
  }
  return T_map_base;
}

void HintTrial::move_to(const Prior& now, const Eigen::Isometry3d& T_map_base) {
  T_map_base_ = T_map_base;
  T_odom_base_ = now.T_odom_base;
  has_height_ = now.height_source != HeightSource::kNone;
  height_m_ = now.height_m;
}

}  // namespace isobar
