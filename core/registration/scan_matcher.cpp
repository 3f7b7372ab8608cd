// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/scan_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

constexpr std::size_t kHolders = 6;

Vector6d free_directions(const Basis& basis) { return basis.rowwise().norm(); }

// Twice the standard deviation of the prediction's position in the directions that the solver may move in.
double free_error_m(const Prediction& prediction, const Basis& basis) {
  return 2.0 * prediction.deviation.tail<3>().dot(basis.bottomRows<3>().rowwise().norm());
}

}  // namespace

ScanMatcher::ScanMatcher(const RegistrationConfig& config, const Eigen::Vector3d& p_base_lidar)
    : config_(config), p_base_lidar_(p_base_lidar), correspondences_(config.sample_points) {}

MatchResult ScanMatcher::match(const MatchProblem& problem) {
  const std::array<PairNoise, 2> noise{pair_noise(problem, false), pair_noise(problem, true)};
  SearchSchedule schedule(config_, free_error_m(problem.prediction, problem.traits.basis));
  MatchResult result;
  result.T_map_base = problem.prediction.T_map_base;
  correspondences_.start(problem.map, result.T_map_base.translation());
  Step step;
  for (int i = 0; i < config_.max_iterations; ++i) {
    const Iteration iteration =
        iterate(problem, noise[schedule.settled() ? 1 : 0], schedule, result.T_map_base);
    step = iteration.step;
    if (!step.solved) return result;
    result.T_map_base = moved_by(step.twist, result.T_map_base);
    count(iteration, problem.p_base.size(), result);
    if (schedule.converged(step.twist)) break;
    schedule.advance(step.twist);
  }
  summarise(problem, step, result);
  return result;
}

ScanMatcher::Iteration ScanMatcher::iterate(const MatchProblem& problem, const PairNoise& noise,
                                            const SearchSchedule& schedule,
                                            const Eigen::Isometry3d& T_map_base) {
  const double distance_m = schedule.distance_m();
  const std::span<const Pair> pairs =
      correspondences_.find(problem.map, problem.p_base, schedule.stride(), T_map_base, p_base_lidar_,
                            distance_m, schedule.choice());
  const float scale_m = residual_scale_m(pairs, noise, static_cast<float>(distance_m) / 2.0F);
  const NormalEquations equations = accumulate(pairs, noise, scale_m);
  Iteration iteration;
  iteration.step = solve_step(equations, prior_term(problem.prediction, T_map_base), problem.traits.basis,
                              weights(scale_m, schedule.share()));
  iteration.pair_count = correspondences_.matched() * schedule.stride();
  iteration.residual_rms_m =
      equations.weight_sum > 0.0 ? std::sqrt(equations.squared_error_sum / equations.weight_sum) : 0.0;
  iteration.level_information = equations.hessian.block<2, 2>(3, 3) * static_cast<double>(schedule.stride());
  return iteration;
}

PairNoise ScanMatcher::pair_noise(const MatchProblem& problem, bool settled) const {
  PairNoise noise;
  const Vector6d free = free_directions(problem.traits.basis);
  const double attitude = config_.attitude_error_deg * kRadPerDeg;
  const double height2 =
      config_.height_error_m * config_.height_error_m + std::clamp(problem.height_variance_m2, 0.0, 1.0);
  Vector6d variance;
  variance << attitude * attitude, attitude * attitude, 0.0, 0.0, 0.0, height2;
  // Roll and pitch are in doubt whether the scan is free in them or not: the planes were laid by scans with such errors,
  // and far from their lidar 0.4 deg outweigh the noise of the range. The search needs its far points as they are.
  const Vector6d in_doubt = settled ? Vector6d(1.0, 1.0, 0.0, 0.0, 0.0, 0.0) : Vector6d::Zero();
  noise.pose_variance = variance.cwiseProduct((Vector6d::Ones() - free).cwiseMax(in_doubt)).cast<float>();
  noise.free = free.cast<float>();
  noise.noise_m = static_cast<float>(config_.min_residual_scale_m);
  return noise;
}

PriorTerm ScanMatcher::prior_term(const Prediction& prediction, const Eigen::Isometry3d& T_map_base) const {
  PriorTerm term;
  term.information = prediction.deviation.cwiseAbs2().cwiseInverse().asDiagonal();
  term.deviation = twist_between(prediction.T_map_base, T_map_base);
  return term;
}

SolverWeights ScanMatcher::weights(float scale_m, double share) const {
  SolverWeights weights;
  weights.pair_information = 1.0 / (config_.correlated_pairs * scale_m * scale_m * share);
  weights.normal_variance = squared(std::sin(config_.normal_error_deg * kRadPerDeg));
  weights.point_variance_m2 = squared(static_cast<double>(scale_m));
  weights.correlated_pairs = config_.correlated_pairs * share;
  return weights;
}

void ScanMatcher::count(const Iteration& iteration, std::size_t sampled_points, MatchResult& result) {
  ++result.iterations;
  result.sampled_points = static_cast<std::uint32_t>(sampled_points);
  result.matched_pairs = static_cast<std::uint32_t>(iteration.pair_count);
  result.residual_rms_m = iteration.residual_rms_m;
  result.level_information = iteration.level_information;
}

void ScanMatcher::summarise(const MatchProblem& problem, const Step& step, MatchResult& result) const {
  result.solved = true;
  if (!problem.p_base.empty()) {
    const double share =
        static_cast<double>(result.matched_pairs) / static_cast<double>(problem.p_base.size());
    result.overlap = std::min(1.0, share);
  }
  result.smallest_eigenvalues = step.smallest_eigenvalues;
  describe_directions(problem, step, prior_term(problem.prediction, result.T_map_base), result);
  const Vector6d fixed = Vector6d::Ones() - free_directions(problem.traits.basis);
  result.twist_covariance = step.covariance;
  result.twist_covariance.diagonal() += fixed.cwiseProduct(problem.prediction.deviation.cwiseAbs2());
}

// The scan, or that part of the prior which knows most of the direction.
void ScanMatcher::describe_directions(const MatchProblem& problem, const Step& step, const PriorTerm& prior,
                                      MatchResult& result) {
  Localisability& out = result.localisability;
  out.count = static_cast<std::uint8_t>(problem.traits.basis.cols());
  for (std::size_t i = 0; i < out.count; ++i) {
    const StepDirection& known = step.directions[i];
    Direction& direction = out.directions[i];
    direction.strength = static_cast<float>(known.strength);
    Eigen::Map<Eigen::Vector3f>(direction.axis.data()) = known.axis.tail<3>().cast<float>();
    Eigen::Map<Eigen::Vector3f>(direction.axis.data() + 3) = known.axis.head<3>().cast<float>();
    double most = direction.strength < Localisability::kWeak ? 0.0 : known.scan_information;
    direction.holder = most > 0.0 ? Holder::kScan : Holder::kMotion;
    std::array<double, kHolders> information{};
    for (int k = 0; k < 6; ++k) {
      // Rotations of the axis are metres at the lever's end.
      const double part = known.axis(k) / (k < 3 ? step.lever_m : 1.0);
      const auto holder = static_cast<std::size_t>(problem.prediction.holders[static_cast<std::size_t>(k)]);
      information[holder] += squared(part) * prior.information(k, k);
    }
    for (std::size_t holder = 0; holder < kHolders; ++holder) {
      if (!(information[holder] > most)) continue;
      most = information[holder];
      direction.holder = static_cast<Holder>(holder);
    }
  }
}

void copy_statistics(const MatchResult& match, PoseEstimate& pose) {
  pose.iterations = match.iterations;
  pose.sampled_points = match.sampled_points;
  pose.matched_pairs = match.matched_pairs;
  pose.residual_rms_m = match.residual_rms_m;
  pose.overlap = match.overlap;
  pose.localisability = match.localisability;
  pose.degenerate = match.localisability.weak_count() > 0;
  pose.smallest_eigenvalues = match.smallest_eigenvalues;
}

}  // namespace isobar
