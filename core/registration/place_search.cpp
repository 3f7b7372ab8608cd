// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.hpp"
#include "core/short_pause.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Half the length of the search around the expected place, and its growth along the track with the distance driven
// unseen.
constexpr double kRadiusM = 1.0;
constexpr double kAlongShare = 0.4;
constexpr double kLargestAlongM = 4.0;
// Spacing of the hypotheses: the ICP finds the pose from half of it.
constexpr double kSpacingM = 1.0;
constexpr double kSpacingAlongM = 0.5;
constexpr double kSpacingRad = 30.0 * kRadPerDeg;
// Of a radius of one spacing the diagonal neighbours are part.
constexpr double kDiagonal = 1.5;
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
// map. Measured at the right place: 0.35 after a corner and 2 s down a shaft, where 0.9 had matched before.
constexpr double kShareAfterPause = 0.3;
// The same of a robot that has driven far unseen, which is outdoors, where ground and facades match at many places
// along a street.
constexpr double kFarM = 1.5;
constexpr double kShareAfterDrive = 0.4;
// Whatever the last scans matched, at least this must match, if as much was known.
constexpr double kLowestOverlap = 0.15;
// Share of the known overlap below which a match must leave no direction free.
constexpr double kDegenerateShare = 0.42;
// Distance between the height of the match and that of the altimeter, whose error is 0.1 m, and 0.4 m beside a door
// that is opened: allowed only where as much matches as before.
constexpr double kLeastClimbM = 0.25;
constexpr double kLargestClimbM = 0.6;
// Residual at the right place: noise of lidar and map; at a wrong one planes of other walls are 0.1 m away.
constexpr double kLargestResidualM = 0.08;
constexpr double kTimesResidual = 1.5;
constexpr double kMoreResidualM = 0.01;
// The same after a short pause: what the robot has just passed is known from a few scans. Measured in a shaft: 0.045
// where 0.01 had been.
constexpr double kTimesAfterPause = 3.0;
constexpr double kMoreAfterPauseM = 0.03;
// Error of the expected pose, 1 sigma: this, and a share of the distance driven unseen. The robot may also have been
// turned by any angle, with this probability density relative to that of the expected yaw.
constexpr double kExpectedM = 0.5;
constexpr double kExpectedShare = 0.2;
constexpr double kExpectedRad = 0.4;
constexpr double kTurnedShare = 0.1;
// Score that leaves no doubt: the other hypotheses are not tried. 1: everything matches at the expected pose.
constexpr double kCertainScore = 0.6;
// Sampled points of a scan that can be judged.
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

}  // namespace

bool PlaceSearch::can_judge(std::size_t sampled_points) { return sampled_points >= kLeastPoints; }

bool PlaceSearch::fits(const Prediction& expected, const MatchResult& result) const {
  const double climb_m = result.T_map_base.translation().z() - expected.T_map_base.translation().z();
  // The floor alone matches wherever the robot is.
  const bool floor_only =
      result.localisability.weak_count() > 0 && result.overlap < kDegenerateShare * known_overlap_;
  const bool much = result.overlap >= kShareOfOverlap * known_overlap_;
  return result.solved && !floor_only &&
         (!has_height_ || std::abs(climb_m) <= (much ? kLargestClimbM : kLeastClimbM)) &&
         can_judge(result.sampled_points) && result.overlap >= least_overlap_ &&
         result.residual_rms_m <= largest_residual_m_;
}

void PlaceSearch::begin(const KnownPlace& place, double pause_s, const ExpectedPlace& expected) {
  const double along_m = std::min(kRadiusM + kAlongShare * expected.unseen_m, kLargestAlongM);
  // The way of a robot that drove on is less certain than its track.
  const Eigen::Vector3d& v = place.v_map_m_s;
  const double track_rad = expected.unseen_m > kRadiusM ? std::atan2(v.y(), v.x()) : 0.0;
  add_hypotheses(along_m, track_rad);
  set_limits(place, is_short_pause(pause_s), expected.unseen_m);
  expected_error_m_ = kExpectedM + kExpectedShare * expected.unseen_m;
  stood_ = expected.stood;
  has_height_ = place.has_height;
  rounds_ = 0;
  active_ = true;
  restart_round();
}

// Beside the track and along it, finer along it; turned by 30 degrees within a metre; turned further on the spot.
void PlaceSearch::add_hypotheses(double along_m, double track_rad) {
  hypotheses_.clear();
  const Eigen::Rotation2Dd R_map_track(track_rad);
  const auto add_around = [&](double half_length_m, double spacing_m, double yaw_rad) {
    const auto steps = static_cast<int>(std::lround(half_length_m / spacing_m));
    for (int along = -steps; along <= steps; ++along) {
      for (int across = -1; across <= 1; ++across) {
        const Eigen::Vector2d p = R_map_track * Eigen::Vector2d(along * spacing_m, across * kSpacingM);
        add(p.x(), p.y(), yaw_rad);
      }
    }
  };
  add_around(along_m, kSpacingAlongM, 0.0);
  add_around(kSpacingM, kSpacingM, kSpacingRad);
  add_around(kSpacingM, kSpacingM, -kSpacingRad);
  const auto turns = static_cast<int>(std::lround(kPi / kSpacingRad));
  for (int turn = 2; turn <= turns; ++turn) {
    add(0.0, 0.0, turn * kSpacingRad);
    if (turn < turns) add(0.0, 0.0, -turn * kSpacingRad);
  }
  sort_hypotheses();
}

void PlaceSearch::add(double x_m, double y_m, double yaw_rad) {
  if (hypotheses_.size() < kMostHypotheses) hypotheses_.push_back({x_m, y_m, yaw_rad, hypotheses_.size()});
}

// The nearest first. Not std::stable_sort, which allocates.
void PlaceSearch::sort_hypotheses() {
  const auto size = [](const Hypothesis& h) {
    return std::hypot(h.x_m, h.y_m) / kSpacingM + std::abs(h.yaw_rad) / kSpacingRad;
  };
  std::sort(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& a, const Hypothesis& b) {
    return std::pair(size(a), a.number) < std::pair(size(b), b.number);
  });
}

void PlaceSearch::begin_around(const HintedPlace& place) {
  hypotheses_.clear();
  const auto steps = static_cast<int>(std::floor(place.radius_m / kSpacingM));
  const auto half_turn = static_cast<int>(std::lround(kPi / kSpacingRad));
  const auto turns = std::min(static_cast<int>(std::lround(place.turn_rad / kSpacingRad)), half_turn);
  for (int x = -steps; x <= steps; ++x) {
    for (int y = -steps; y <= steps; ++y) {
      if (std::hypot(x, y) * kSpacingM > std::max(place.radius_m, kDiagonal * kSpacingM)) continue;
      for (int turn = turns == half_turn ? 1 - turns : -turns; turn <= turns; ++turn) {
        add(x * kSpacingM, y * kSpacingM, turn * kSpacingRad);
      }
    }
  }
  sort_hypotheses();
  KnownPlace known;
  known.overlap = place.overlap;
  known.residual_rms_m = place.residual_rms_m;
  set_limits(known, false, 0.0);
  expected_error_m_ = place.sigma_m;
  stood_ = false;
  has_height_ = place.has_height;
  rounds_ = kRounds - 1;
  active_ = true;
  restart_round();
}

void PlaceSearch::set_limits(const KnownPlace& place, bool short_pause, double unseen_m) {
  known_overlap_ = 1.0;
  least_overlap_ = kLeastOverlap;
  largest_residual_m_ = kLargestResidualM;
  if (place.overlap <= 0.0) return;
  known_overlap_ = place.overlap;
  const double after_pause = unseen_m < kFarM ? kShareAfterPause : kShareAfterDrive;
  least_overlap_ = std::max((short_pause ? after_pause : kShareOfOverlap) * place.overlap,
                            std::min(kLowestOverlap, place.overlap));
  const double residual_m = short_pause ? kTimesAfterPause * place.residual_rms_m + kMoreAfterPauseM
                                        : kTimesResidual * place.residual_rms_m + kMoreResidualM;
  largest_residual_m_ = std::min(residual_m, kLargestResidualM);
}

void PlaceSearch::restart_round() {
  next_ = 0;
  best_score_ = 0.0;
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
  if (!fits(expected, result)) return;
  const double score = result.overlap / known_overlap_ * expectation(expected, result);
  if (score <= best_score_) return;
  best_score_ = score;
  best_correction_ = result.T_map_base * expected.T_map_base.inverse(Eigen::Isometry);
}

// Probability density of the found pose, relative to that of the expected one.
double PlaceSearch::expectation(const Prediction& expected, const MatchResult& result) const {
  const Eigen::Vector3d step = result.T_map_base.translation() - expected.T_map_base.translation();
  const Eigen::Matrix3d turn = result.T_map_base.linear() * expected.T_map_base.linear().transpose();
  const double turn_rad = rotation_angle_rad(Eigen::Quaterniond(turn));
  return std::exp(-0.5 * squared(step.head<2>().norm() / expected_error_m_)) *
         (kTurnedShare + (1.0 - kTurnedShare) * std::exp(-0.5 * squared(turn_rad / kExpectedRad)));
}

PlaceVerdict PlaceSearch::end_of_scan() {
  const bool all_tried = next_ >= hypotheses_.size();
  if (best_score_ >= kCertainScore || (all_tried && best_score_ > 0.0)) {
    found_ = true;
    return PlaceVerdict::kFound;
  }
  if (!all_tried) return PlaceVerdict::kSearching;
  return end_of_round();
}

// A robot that stood needs one round: it has not driven into a place that it knows better.
PlaceVerdict PlaceSearch::end_of_round() {
  if (stood_) return PlaceVerdict::kUnseen;
  if (++rounds_ >= kRounds) return PlaceVerdict::kUnknown;
  restart_round();
  return PlaceVerdict::kSearching;
}

PlaceVerdict PlaceSearch::confirm(const Prediction& expected, const MatchResult& result) {
  if (fits(expected, result))
    return ++confirmations_ >= kConfirmingScans ? PlaceVerdict::kConfirmed : PlaceVerdict::kFound;
  confirmations_ = 0;
  if (++refusals_ <= kMaxRefusals) return PlaceVerdict::kFound;
  return end_of_round();
}

Prediction PlaceSearch::near(const Prediction& expected) { return with_error(expected, kFoundM, kFoundRad); }

}  // namespace isobar
