// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/loop_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Least error of the prediction that the ICP is given, so that the scan decides, not the guess.
constexpr double kLeastLevelM = 0.5;
constexpr double kLeastHeightM = 0.2;
constexpr double kLeastYawRad = 2.0 * kRadPerDeg;
constexpr double kMatchTiltRad = 0.2 * kRadPerDeg;
// Distance between hypotheses [m]: an ICP finds the nearest wall from half of it.
constexpr double kHypothesisM = 0.8;
constexpr int kMostRings = 3;
// Error of a submap within itself, 1 sigma: what it bends over its way.
constexpr double kSubmapLevelM = 0.02;
constexpr double kSubmapHeightM = 0.015;
constexpr double kSubmapYawRad = 0.1 * kRadPerDeg;
// Key scans of the submap whose points are tested against the rays of the key scan [m].
constexpr double kNearM = 6.0;
// A ray passes through what is this far in front of its end [m].
constexpr float kMarginM = 0.5F;

RegistrationConfig of_loops(RegistrationConfig config, std::size_t sample_points) {
  config.sample_points = sample_points;
  config.max_iterations = 20;  // not on the way of a scan: convergence counts more than time
  return config;
}

Prediction prediction_of(const LoopGuess& guess) {
  Prediction prediction;
  prediction.T_map_base = guess.T_submap_base;
  const double level_m = std::max(guess.level_sigma_m, kLeastLevelM);
  prediction.deviation << kMatchTiltRad, kMatchTiltRad, std::max(guess.yaw_sigma_rad, kLeastYawRad), level_m,
      level_m, std::max(guess.height_sigma_m, kLeastHeightM);
  return prediction;
}

}  // namespace

LoopMatcher::LoopMatcher(const LoopCriteria& criteria, const RegistrationConfig& registration,
                         std::size_t sample_points, float spacing_m, const Eigen::Isometry3d& T_base_lidar)
    : criteria_(criteria),
      T_lidar_base_(T_base_lidar.inverse()),
      traits_(traits_of(Method::k4Dof, HeightSource::kNone)),
      matcher_(of_loops(registration, sample_points), T_base_lidar.translation()),
      free_space_(spacing_m) {}

std::optional<Loop> LoopMatcher::match(const Submap& submap, const KeyScan& key, const LoopGuess& guess) {
  const MatchResult result = best_match(submap, key, guess);
  if (!acceptable(result, guess) || contradiction(submap, result.T_map_base) > criteria_.max_contradiction) {
    return std::nullopt;
  }
  Loop loop;
  loop.submap = submap.number;
  loop.stamp_ns = key.stamp_ns;
  loop.way_m = key.way_m;
  loop.T_submap_base = result.T_map_base;
  loop.T_holder_base = key.T_submap_base;
  loop.covariance = as_pose_covariance(result.twist_covariance);
  Vector6d within;
  within << kSubmapLevelM, kSubmapLevelM, kSubmapHeightM, kMatchTiltRad, kMatchTiltRad, kSubmapYawRad;
  loop.covariance.diagonal() += within.cwiseAbs2();
  loop.overlap = result.overlap;
  loop.residual_rms_m = result.residual_rms_m;
  return loop;
}

// Rings of hypotheses around the guess, as far as its error reaches; the one that explains most of the scan.
MatchResult LoopMatcher::best_match(const Submap& submap, const KeyScan& key, const LoopGuess& guess) {
  const int rings =
      std::clamp(static_cast<int>(std::ceil((2.0 * guess.level_sigma_m - kHypothesisM / 2.0) / kHypothesisM)),
                 0, kMostRings);
  MatchResult best;
  for (int x = -rings; x <= rings; ++x) {
    for (int y = -rings; y <= rings; ++y) {
      Prediction prediction = prediction_of(guess);
      prediction.T_map_base.pretranslate(Eigen::Vector3d(x, y, 0.0) * kHypothesisM);
      const MatchResult result = matcher_.match({*submap.planes, key.p_base, traits_, prediction, 0.0});
      if (result.solved && result.overlap > best.overlap) best = result;
    }
  }
  return best;
}

bool LoopMatcher::acceptable(const MatchResult& result, const LoopGuess& guess) const {
  const double z_m = result.T_map_base.translation().z() - guess.T_submap_base.translation().z();
  return result.solved && result.overlap >= criteria_.min_overlap &&
         result.residual_rms_m <= criteria_.max_residual_m &&
         std::abs(z_m) <= criteria_.height_sigmas * std::hypot(guess.height_sigma_m, kSubmapHeightM);
}

// Free space: points that the submap saw near here, in the range image of the key scan.
double LoopMatcher::contradiction(const Submap& submap, const Eigen::Isometry3d& T_submap_base) const {
  std::size_t seen = 0;
  std::size_t passed = 0;
  const Eigen::Isometry3d T_lidar_submap = T_lidar_base_ * T_submap_base.inverse();
  for (const KeyScan& key : submap.keys) {
    if ((key.T_submap_base.translation() - T_submap_base.translation()).norm() > kNearM) continue;
    const Eigen::Isometry3f T_lidar_key = (T_lidar_submap * key.T_submap_base).cast<float>();
    for (std::size_t first = 0; first < key.p_base.size(); first += FreeSpace::Points::kMost) {
      const std::size_t count = std::min(FreeSpace::Points::kMost, key.p_base.size() - first);
      FreeSpace::Points p_lidar;
      for (std::size_t i = 0; i < count; ++i) p_lidar.set(i, T_lidar_key * key.p_base[first + i]);
      FreeSpace::Ranges ranges;
      free_space_.min_ranges(p_lidar, count, ranges);
      for (std::size_t i = 0; i < count; ++i) {
        if (!(ranges[i] > 0.0F)) continue;
        ++seen;
        passed += p_lidar.at(i).norm() + kMarginM < ranges[i] ? 1 : 0;
      }
    }
  }
  return seen == 0 ? 0.0 : static_cast<double>(passed) / static_cast<double>(seen);
}

}  // namespace isobar
