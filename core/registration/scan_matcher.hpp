// SPDX-License-Identifier: BSD-3-Clause
// The ICP of one scan:
//
//     ┌▶ correspondences ─▶ residual scale ─▶ normal equations ─▶ Gauss-Newton step ─▶ moved pose ─┐
//     │        ▲                                                          ▲                        │
//     │   map, sample                                                   prior                      │
//     └─────────────────── schedule: share of the points, search distance ◀────────────────────────┘
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>

#include "core/estimates.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/registration/correspondences.hpp"
#include "core/registration/method.hpp"
#include "core/registration/motion_model.hpp"
#include "core/registration/point_to_plane.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/search_schedule.hpp"
#include "core/registration/solver.hpp"

namespace isobar {

/// A scan to be matched.
struct MatchProblem {
  const MapSnapshot& map;                   ///< not empty
  std::span<const Eigen::Vector3f> p_base;  ///< sampled points [m]
  const MethodTraits& traits;
  const Prediction& prediction;     ///< where the search starts, and the prior term
  double height_variance_m2 = 0.0;  ///< of the altimeter, where it fixes z
};

/// Result of the ICP. Where !solved only the statistics of the iterations before are set.
struct MatchResult {
  bool solved = false;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Matrix6d twist_covariance = Matrix6d::Zero();  ///< see twist.hpp

  std::uint32_t iterations = 0;
  std::uint32_t sampled_points = 0;
  std::uint32_t matched_pairs = 0;  ///< of the last iteration
  double residual_rms_m = 0.0;      ///< of the last iteration, weighted

  double overlap = 0.0;  ///< matched_pairs / sampled_points, 0 … 1
  /// Sum of w n n^T over the pairs, horizontal part: how firmly planes hold the pose along x and y of the map.
  Eigen::Matrix2d level_information = Eigen::Matrix2d::Zero();
  Localisability localisability;
  Eigen::Vector3d smallest_eigenvalues = Eigen::Vector3d::Zero();
};

/// Fills the fields of the pose that describe its match.
void copy_statistics(const MatchResult& match, PoseEstimate& pose);

/// Matches scans to the map. Allocates in its constructor only. Not thread-safe.
class ScanMatcher {
 public:
  /// `p_base_lidar`: position of the lidar in base_link [m].
  ScanMatcher(const RegistrationConfig& config, const Eigen::Vector3d& p_base_lidar);

  /// `problem.p_base` has RegistrationConfig::sample_points at most.
  MatchResult match(const MatchProblem& problem);

 private:
  struct Iteration {
    Step step;
    std::size_t pair_count = 0;  // scaled up to all points
    double residual_rms_m = 0.0;
    Eigen::Matrix2d level_information = Eigen::Matrix2d::Zero();  // scaled up to all points
  };

  [[nodiscard]] PairNoise pair_noise(const MatchProblem& problem, bool settled) const;
  [[nodiscard]] PriorTerm prior_term(const Prediction& prediction, const Eigen::Isometry3d& T_map_base) const;
  [[nodiscard]] SolverWeights weights(float scale_m, double share) const;
  Iteration iterate(const MatchProblem& problem, const PairNoise& noise, const SearchSchedule& schedule,
                    const Eigen::Isometry3d& T_map_base);
  static void count(const Iteration& iteration, std::size_t sampled_points, MatchResult& result);
  static void describe_directions(const MatchProblem& problem, const Step& step, const PriorTerm& prior,
                                  MatchResult& result);
  void summarise(const MatchProblem& problem, const Step& step, MatchResult& result) const;

  RegistrationConfig config_;
  Eigen::Vector3d p_base_lidar_;
  Correspondences correspondences_;
};

}  // namespace isobar
