// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/place_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Pause for which a robot may have kept its velocity; after a longer one it is expected where it was.
constexpr double kDriveOnS = 10.0;
// Radius of the search around the expected place, and its growth with the distance driven unseen.
constexpr double kRadiusM = 1.0;
constexpr double kRadiusShare = 0.5;
constexpr double kLargestRadiusM = 3.0;
// Spacing of the hypotheses: the ICP finds the pose from half of it.
constexpr double kSpacingM = 1.0;
constexpr double kSpacingRad = 30.0 * kRadPerDeg;
// Error of a hypothesis, 1 sigma.
constexpr double kHypothesisM = 0.4;
constexpr double kHypothesisRad = 0.2;
// The same of a place that was found.
constexpr double kFoundM = 0.15;
constexpr double kFoundRad = 0.05;
// Share of the scan's points that match the map at the right place: 0.7 … 1 in known places, less where
// the robot sees past the edge of the map. Where that of the last scans is known, this share of it: people and
// doors have moved since.
constexpr double kLeastOverlap = 0.6;
constexpr double kShareOfOverlap = 0.8;
// The same after a short pause, when the robot cannot be in another building: it has driven past the edge of the
// map, of which the tiles of the last 8 s may be missing. Measured where 0.91 had matched before: 0.7 in a corridor,
// 0.53 behind a corner, at wrong places below 0.3, with residuals from 0.07 m.
constexpr double kShareAfterPause = 0.45;
// Overlap that leaves no doubt: the other hypotheses are not tried.
constexpr double kCertainOverlap = 0.85;
constexpr double kCertainShare = 0.95;
constexpr double kCertainShareAfterPause = 0.5;
// Residual at the right place: noise of lidar and map; at a wrong one planes of other walls are 0.1 m away.
constexpr double kLargestResidualM = 0.08;
constexpr double kTimesResidual = 1.5;
constexpr double kMoreResidualM = 0.01;
// Sampled points of a scan that can be judged: the first revolution may be incomplete.
constexpr std::uint32_t kLeastPoints = 150;
constexpr int kConfirmingScans = 3;
constexpr int kMaxRefusals = 2;
// The hypotheses are tried twice: the robot may have driven into a place that it knows better.
constexpr int kRounds = 2;

Prediction with_error(Prediction prediction, double translation_m, double yaw_rad) {
  prediction.deviation(2) = std::max(prediction.deviation(2), yaw_rad);
  prediction.deviation(3) = std::max(prediction.deviation(3), translation_m);
  prediction.deviation(4) = std::max(prediction.deviation(4), translation_m);
  return prediction;
}

bool is_short(double pause_s) { return pause_s > 0.0 && pause_s < kDriveOnS; }

}  // namespace

bool PlaceSearch::fits(const MatchResult& result) const {
  return result.solved && result.sampled_points >= kLeastPoints && result.overlap >= least_overlap_ &&
         result.residual_rms_m <= largest_residual_m_;
}

Eigen::Isometry3d PlaceSearch::expected_pose(const KnownPlace& place, std::int64_t now_ns) {
  const double pause_s = seconds_between(place.stamp_ns, now_ns);
  Eigen::Isometry3d pose = place.T_map_base;
  if (is_short(pause_s)) {
    const Eigen::Vector3d way_m = place.v_map_m_s * pause_s;
    pose.translation() += way_m * std::min(1.0, kLargestRadiusM / std::max(way_m.norm(), 1e-9));
  }
  return pose;
}

void PlaceSearch::begin(const KnownPlace& place, std::int64_t now_ns) {
  const double way_m =
      (expected_pose(place, now_ns).translation() - place.T_map_base.translation()).head<2>().norm();
  const double radius_m = std::min(kRadiusM + kRadiusShare * way_m, kLargestRadiusM);
  hypotheses_.clear();
  const auto reach = static_cast<int>(radius_m / kSpacingM);
  const auto turns = static_cast<int>(std::lround(kPi / kSpacingRad));
  for (int yaw = -turns + 1; yaw <= turns; ++yaw) {
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) {
        const Hypothesis h{x * kSpacingM, y * kSpacingM, yaw * kSpacingRad};
        // A robot that was turned by more than half a right angle was not moved as well.
        const bool turned = std::abs(h.yaw_rad) > 1.5 * kSpacingRad;
        const double distance_m = std::hypot(h.x_m, h.y_m);
        if (distance_m <= (turned ? 0.0 : radius_m)) hypotheses_.push_back(h);
      }
    }
  }
  const auto size = [](const Hypothesis& h) {
    return std::hypot(h.x_m, h.y_m) / kSpacingM + std::abs(h.yaw_rad) / kSpacingRad;
  };
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [&](const Hypothesis& a, const Hypothesis& b) { return size(a) < size(b); });
  const bool known = place.overlap > 0.0;
  const bool paused = is_short(seconds_between(place.stamp_ns, now_ns));
  least_overlap_ = known ? (paused ? kShareAfterPause : kShareOfOverlap) * place.overlap : kLeastOverlap;
  certain_overlap_ =
      known ? (paused ? kCertainShareAfterPause : kCertainShare) * place.overlap : kCertainOverlap;
  largest_residual_m_ =
      known ? std::min(kTimesResidual * place.residual_rms_m + kMoreResidualM, kLargestResidualM)
            : kLargestResidualM;
  rounds_ = 0;
  active_ = true;
  restart_round();
}

void PlaceSearch::restart_round() {
  next_ = 0;
  best_overlap_ = 0.0;
  best_correction_.setIdentity();
  confirmations_ = refusals_ = 0;
  found_ = false;
}

Prediction PlaceSearch::next(const Prediction& expected) {
  const Hypothesis& h = hypotheses_[std::min(next_, hypotheses_.size() - 1)];
  ++next_;
  Prediction at = with_error(expected, kHypothesisM, kHypothesisRad);
  at.T_map_base.linear() = rotation_about_z(h.yaw_rad) * at.T_map_base.linear();
  at.T_map_base.translation().head<2>() += Eigen::Vector2d(h.x_m, h.y_m);
  return at;
}

void PlaceSearch::judge(const Prediction& expected, const MatchResult& result) {
  if (!fits(result) || result.overlap <= best_overlap_) return;
  best_overlap_ = result.overlap;
  best_correction_ = result.T_map_base * expected.T_map_base.inverse(Eigen::Isometry);
}

PlaceVerdict PlaceSearch::end_of_scan() {
  const bool all_tried = next_ >= hypotheses_.size();
  if (best_overlap_ >= certain_overlap_ || (all_tried && best_overlap_ > 0.0)) {
    found_ = true;
    return PlaceVerdict::kFound;
  }
  if (!all_tried) return PlaceVerdict::kSearching;
  if (++rounds_ >= kRounds) return PlaceVerdict::kUnknown;
  restart_round();
  return PlaceVerdict::kSearching;
}

PlaceVerdict PlaceSearch::confirm(const MatchResult& result) {
  if (fits(result))
    return ++confirmations_ >= kConfirmingScans ? PlaceVerdict::kConfirmed : PlaceVerdict::kFound;
  confirmations_ = 0;
  if (++refusals_ <= kMaxRefusals) return PlaceVerdict::kFound;
  if (++rounds_ >= kRounds) return PlaceVerdict::kUnknown;
  restart_round();
  return PlaceVerdict::kSearching;
}

Prediction PlaceSearch::near(const Prediction& expected) { return with_error(expected, kFoundM, kFoundRad); }

}  // namespace isobar
