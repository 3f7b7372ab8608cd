// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/cold_start.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/place/ray_dispute.hpp"
#include "core/place/slab_heights.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Error of a hypothesis of the search in x and y, of its heading, and of a candidate after a motion by odometry, 1 sigma.
constexpr double kHypothesisM = 0.15;
constexpr double kHypothesisRad = 0.03;
constexpr double kLeastFollowedM = 0.1;
constexpr double kFollowedShare = 0.05;
// Error of height between map and altimeter besides the altimeter's own.
constexpr double kHeightErrorM = 0.15;
// Poses nearer to each other are one candidate.
constexpr double kSameM = 0.5;
constexpr double kSameRad = 0.15;
// Candidates of less weight are dropped.
constexpr double kLeastWeight = 1e-3;
// Share of ground, ceilings and the like on surfaces, below which the height is looked at again: right poses have 0.68 … 0.99.
constexpr double kDoubtfulHeightFit = 0.6;
// Candidates that are compared ray by ray, 10 ms each.
constexpr std::size_t kMostDisputed = 6;

Prediction prediction_at(const Eigen::Isometry3d& T_map_level, double error_m, double height_sigma_m) {
  Prediction prediction;
  prediction.T_map_base = T_map_level;
  prediction.deviation << 1e-3, 1e-3, kHypothesisRad, error_m, error_m, std::clamp(height_sigma_m, 0.05, 0.5);
  return prediction;
}

Eigen::Isometry3d level_pose(double x_m, double y_m, double z_m, double yaw_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_about_z(yaw_rad);
  T.translation() << x_m, y_m, z_m;
  return T;
}

double yaw_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return rotation_angle_rad(Eigen::Quaterniond(a.linear().transpose() * b.linear()));
}

// The altimeter's, unless it does not tell the floor: then that of the candidate, which odometry has carried.
SlabHeight followed_height(const SlabHeight& height, double carried_z_m) {
  constexpr double kLargestSigmaM = 0.34;  // 3 sigma are a metre: less than a storey
  return height.sigma_m <= kLargestSigmaM ? height : SlabHeight{carried_z_m, kLargestSigmaM};
}

bool usable(const SlabHeight& height) {
  return std::abs(height.z_m) < 1e5 && height.sigma_m >= 0.0 && height.sigma_m < 1e3;
}

bool usable(const SearchArea& hint) {
  return std::abs(hint.x_m) < 1e7 && std::abs(hint.y_m) < 1e7 && std::abs(hint.yaw_rad) < 1e3 &&
         (hint.sigma_m.array() > 0.0).all() && (hint.sigma_m.array() < 1e6).all() && hint.sigma_yaw_rad > 0.0;
}

SearchWindow window_of(const std::optional<SearchArea>& hint) {
  SearchWindow window;
  if (!hint) return window;
  const Eigen::Vector2d p(hint->x_m, hint->y_m);
  window.box.low = p - 3.0 * hint->sigma_m;
  window.box.high = p + 3.0 * hint->sigma_m;
  window.yaw_rad = hint->yaw_rad;
  window.half_yaw_rad = std::min(3.0 * hint->sigma_yaw_rad, std::numbers::pi);
  return window;
}

}  // namespace

ColdStart::ColdStart(const ColdStartConfig& config, const RegistrationConfig& registration)
    : config_(config),
      registration_(registration),
      traits_(traits_of(Method::k4Dof, HeightSource::kDifferential)),
      matcher_(registration, Eigen::Vector3d::Zero()) {}

const ColdStartResult& ColdStart::locate(const ColdStartInput& input, const std::optional<SearchArea>& hint) {
  result_ = {};
  judged_.clear();
  if (input.query.can_judge() && usable(input.height) && (!hint || usable(*hint))) {
    // The lidar's place in the level frame decides which planes face it.
    matcher_ = ScanMatcher(registration_, input.query.p_level_lidar().cast<double>());
    for (const SlabHeight& height :
         slab_heights(input.map.structure(), input.height, -input.query.ground_z_m())) {
      search_slab(input, height, hint);
      refine(input, height);
    }
  }
  judge(input, hint.has_value());
  return result_;
}

void ColdStart::search_slab(const ColdStartInput& input, const SlabHeight& height,
                            const std::optional<SearchArea>& hint) {
  hypotheses_.clear();
  const SearchWindow window = window_of(hint);
  if (!image_.build(input.map.structure(), height, window.box)) return;
  pyramid_.build(image_);
  const std::vector<SlabPose>& poses =
      search_.find(image_, pyramid_, input.query.columns(), window, config_.search);
  result_.complete = result_.complete && search_.complete();
  result_.tried += poses.size();
  for (const SlabPose& pose : poses) {
    hypotheses_.push_back({pose, height.z_m, coarse_fit(image_, input.query, pose).score()});
  }
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.fit > b.fit; });
  if (hypotheses_.size() > config_.refined) hypotheses_.resize(config_.refined);
}

void ColdStart::refine(const ColdStartInput& input, const SlabHeight& height) {
  for (const Hypothesis& hypothesis : hypotheses_) {
    const SlabPose& pose = hypothesis.pose;
    const Eigen::Isometry3d T_map_level = level_pose(pose.x_m, pose.y_m, hypothesis.z_m, pose.yaw_rad);
    if (auto judged = refined(input, height, T_map_level, kHypothesisM)) add_candidate(std::move(*judged));
  }
}

std::optional<ColdStart::Judged> ColdStart::refined(const ColdStartInput& input, const SlabHeight& height,
                                                    const Eigen::Isometry3d& T_map_level, double error_m) {
  std::optional<Judged> judged = matched(input, height, T_map_level, error_m);
  if (!judged) return std::nullopt;
  PlaceCandidate& candidate = judged->candidate;
  // Where the altimeter is off by some decimetres, ground and ceiling are too far away for the ICP.
  if (candidate.fit.others < kDoubtfulHeightFit) {
    Eigen::Isometry3d T_moved = candidate.T_map_level;
    T_moved.translation().z() += vertical_offset_m(*input.map.snapshot(), input.query, T_moved, matches_);
    auto moved = matched(input, height, T_moved, error_m);
    if (moved && moved->evidence.sum() > judged->evidence.sum()) judged = std::move(moved);
  }
  const double climb_m = candidate.T_map_level.translation().z() - input.height.z_m;
  const double relative = climb_m / std::hypot(input.height.sigma_m, kHeightErrorM);
  if (candidate.fit.score() < config_.least_fit || std::abs(relative) > 3.0) return std::nullopt;
  candidate.weight = -0.5 * squared(relative);
  candidate.T_map_base = candidate.T_map_level;
  candidate.T_map_base.linear() = candidate.T_map_level.linear() * input.R_level_base;
  return judged;
}

// The ICP, and how well its result fits.
std::optional<ColdStart::Judged> ColdStart::matched(const ColdStartInput& input, const SlabHeight& height,
                                                    const Eigen::Isometry3d& T_map_level, double error_m) {
  const Prediction prediction = prediction_at(T_map_level, error_m, height.sigma_m);
  const MatchResult match = matcher_.match(
      {*input.map.snapshot(), input.query.sample(), traits_, prediction, squared(height.sigma_m)});
  if (!match.solved) return std::nullopt;
  Judged judged;
  judged.candidate.T_map_level = match.T_map_base;
  judged.candidate.fit =
      fine_fit(*input.map.snapshot(), image_, input.query, match.T_map_base, matches_, judged.evidence);
  return judged;
}

// Of two hypotheses that the ICP leads to one place, the better one is kept.
void ColdStart::add_candidate(Judged judged) {
  const Eigen::Isometry3d& T = judged.candidate.T_map_base;
  for (Judged& known : judged_) {
    const Eigen::Isometry3d& T_known = known.candidate.T_map_base;
    if ((T_known.translation() - T.translation()).norm() > kSameM || yaw_between(T_known, T) > kSameRad)
      continue;
    if (judged.score() > known.score()) known = std::move(judged);
    return;
  }
  judged_.push_back(std::move(judged));
}

// A candidate that fits worse than the best one by n standard deviations is exp(-n^2 / 2) times as likely.
void ColdStart::judge(const ColdStartInput& input, bool hinted) {
  result_.candidates.clear();
  if (judged_.empty()) {
    result_.verdict = hinted ? ColdStartVerdict::kHintRefused : ColdStartVerdict::kUnknown;
    return;
  }
  std::stable_sort(judged_.begin(), judged_.end(),
                   [](const Judged& a, const Judged& b) { return a.score() > b.score(); });
  if (judged_.size() > config_.most_candidates) judged_.resize(config_.most_candidates);
  const Judged& best = judged_.front();
  double sum = 0.0;
  for (const Judged& one : judged_) {
    const double lead = std::max(PlaceEvidence::lead(best.evidence, one.evidence), 0.0);
    result_.candidates.push_back(one.candidate);
    double& weight = result_.candidates.back().weight;
    weight = std::exp(std::min(weight - best.candidate.weight, 0.0) - 0.5 * squared(lead));
    sum += weight;
  }
  for (PlaceCandidate& one : result_.candidates) one.weight /= sum;
  if (result_.candidates.front().weight < config_.certain_weight) settle(input);
  std::erase_if(result_.candidates, [](const PlaceCandidate& one) { return one.weight < kLeastWeight; });
  const bool certain = result_.candidates.front().weight >= config_.certain_weight;
  result_.verdict = certain ? ColdStartVerdict::kFound : ColdStartVerdict::kAmbiguous;
}

// Between places that the sample does not tell apart, single rays may.
void ColdStart::settle(const ColdStartInput& input) {
  std::vector<PlaceCandidate>& candidates = result_.candidates;
  std::size_t best = 0;
  for (std::size_t i = 1; i < std::min(candidates.size(), kMostDisputed); ++i) {
    if (candidates[i].weight < kLeastWeight) continue;
    const RayDispute::Winner winner =
        dispute(*input.map.snapshot(), input.query, candidates[best].T_map_level, candidates[i].T_map_level)
            .winner();
    if (winner == RayDispute::Winner::kOne) candidates[i].weight = 0.0;
    if (winner == RayDispute::Winner::kOther) candidates[std::exchange(best, i)].weight = 0.0;
  }
  double sum = 0.0;
  for (const PlaceCandidate& one : candidates) sum += one.weight;
  for (PlaceCandidate& one : candidates) one.weight /= sum;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.weight > b.weight; });
}

const ColdStartResult& ColdStart::follow(const ColdStartInput& input, const Eigen::Isometry3d& T_before_now) {
  if (!usable(input.height) || !T_before_now.matrix().allFinite()) return result_;
  const std::vector<PlaceCandidate> before = std::exchange(result_.candidates, {});
  judged_.clear();
  matcher_ = ScanMatcher(registration_, input.query.p_level_lidar().cast<double>());
  const double driven_m = T_before_now.translation().head<2>().norm();
  for (const PlaceCandidate& old : before) {
    Eigen::Isometry3d T_map_level = old.T_map_level * T_before_now;
    const SlabHeight height = followed_height(input.height, T_map_level.translation().z());
    T_map_level.translation().z() = height.z_m;
    const Eigen::Vector2d p = T_map_level.translation().head<2>();
    if (!image_.build(input.map.structure(), height, {p.array() - 1.0, p.array() + 1.0})) continue;
    auto judged = refined(input, height, T_map_level, kLeastFollowedM + kFollowedShare * driven_m);
    if (!judged) continue;
    judged->candidate.weight += std::log(std::max(old.weight, kLeastWeight));
    add_candidate(std::move(*judged));
  }
  judge(input, false);
  return result_;
}

}  // namespace isobar
