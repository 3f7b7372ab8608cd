// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/graph/whitening.hpp"

namespace isobar {

namespace {

// Rounding of poses that went through files as single precision.
constexpr double kRotationTolerance = 1e-5;
// Largest coordinate [m]: the Earth is smaller. Squares of larger ones would lose what is good to rounding.
constexpr double kLargestM = 1e7;

bool is_coordinate(double value_m) { return std::abs(value_m) <= kLargestM; }  // false for NaN

bool is_pose(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  return T.matrix().allFinite() && T.translation().cwiseAbs().maxCoeff() <= kLargestM &&
         R.determinant() > 0.0 && (R * R.transpose()).isIdentity(kRotationTolerance);
}

bool is_sigma(double sigma) { return std::isfinite(sigma) && sigma >= kLeastSigma; }

}  // namespace

PoseGraph::PoseGraph(const PoseGraphConfig& config) : config_(config) { factors_.bias = config.bias; }

std::optional<NodeId> PoseGraph::add_node(const GraphNode& node) {
  if (!is_pose(node.T_map_submap)) return std::nullopt;
  state_.nodes.push_back(node);
  state_.bias_m.push_back(0.0);
  changed();
  return static_cast<NodeId>(state_.nodes.size()) - 1;
}

std::optional<WhitenedEdge> PoseGraph::whitened(const RelativePoseEdge& edge) const {
  const bool exist = exists(edge.from) && exists(edge.to) && edge.from != edge.to;
  if (!exist || !is_pose(edge.T_from_to)) return std::nullopt;
  const bool level = held(edge.from) && held(edge.to);
  const std::optional<Matrix6d> W = whitening(edge.covariance, level);
  if (!W) return std::nullopt;
  return WhitenedEdge{edge, *W, level};
}

bool PoseGraph::add_edge(const RelativePoseEdge& edge) {
  const std::optional<WhitenedEdge> taken = whitened(edge);
  if (!taken) return false;
  if (edge.kind == EdgeKind::kOdometry) {
    factors_.odometry.push_back(*taken);
    return changed();
  }
  factors_.loops.push_back(*taken);
  taken_.push_back(0);
  verdicts_.emplace_back();
  return changed();
}

bool PoseGraph::add_altitude(const AltitudeFactor& factor) {
  if (!exists(factor.node) || !is_coordinate(factor.height_m) || !is_sigma(factor.sigma_m)) return false;
  factors_.altitudes.push_back(factor);
  return changed();
}

bool PoseGraph::add_stationary_ground(const StationaryGround& factor) {
  if (!exists(factor.a) || !exists(factor.b) || factor.a == factor.b || !is_sigma(factor.sigma_m))
    return false;
  factors_.grounds.push_back(factor);
  return changed();
}

bool PoseGraph::add_prior(const PosePrior& prior) {
  if (!exists(prior.node) || !is_pose(prior.T_map_submap)) return false;
  const std::optional<Matrix6d> W = whitening(prior.covariance, held(prior.node));
  if (!W) return false;
  factors_.priors.push_back({prior, *W});
  return changed();
}

bool PoseGraph::anchor(NodeId node) {
  if (!exists(node)) return false;
  factors_.anchors.push_back(node);
  return changed();
}

bool PoseGraph::changed() {
  structure_changed_ = true;
  factorised_ = false;
  return true;
}

void PoseGraph::rebuild() {
  if (!structure_changed_) return;
  order_biases(state_.nodes, factors_);
  restructure(state_.nodes, factors_, system_);
  structure_changed_ = false;
}

GraphResult PoseGraph::optimise() {
  if (state_.nodes.empty()) return {true, 0, 0.0, 0};
  rebuild();
  const auto is_new = [&](std::size_t i) { return verdicts_[i].gate == 0.0; };
  LoopSelection selection(factors_, config_.loops, config_.limits, system_, state_);
  Relaxation relaxation = selection.run(taken_);
  bool refused = false;
  for (std::size_t i = 0; i < taken_.size(); ++i) refused |= is_new(i) && selection.taken()[i] == 0;
  // A new loop that contradicts may be right and an older one wrong: without the older ones, both have the same chance.
  if (refused && std::find(taken_.begin(), taken_.end(), 1) != taken_.end()) {
    const int before = relaxation.iterations;
    relaxation = selection.run(LoopWeights(taken_.size(), 0));
    relaxation.iterations += before;
  }
  return report(selection, relaxation);
}

GraphResult PoseGraph::report(const LoopSelection& selection, const Relaxation& relaxation) {
  GraphResult result{relaxation.converged, relaxation.iterations, relaxation.chi_square, 0};
  taken_ = selection.taken();
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    verdicts_[i] = {static_cast<double>(taken_[i]), selection.distances()[i], selection.gate_of(i)};
    result.loops_taken += taken_[i];
  }
  factorised_ = relaxation.converged;
  return result;
}

bool PoseGraph::factorise() {
  if (factorised_) return true;
  rebuild();
  linearise(factors_, taken_, state_, system_);
  factorised_ = system_.factorise(0.0);
  return factorised_;
}

std::optional<LoopVerdict> PoseGraph::judge(const RelativePoseEdge& candidate) {
  const std::optional<WhitenedEdge> loop = whitened(candidate);
  if (!loop || !factorise()) return std::nullopt;
  const double distance = loop_distance(*loop, false, state_, system_);
  const double gate = config_.loops.of(*loop);
  return LoopVerdict{distance <= gate ? 1.0 : 0.0, distance, gate};
}

std::optional<Matrix6d> PoseGraph::relative_covariance(NodeId from, NodeId to) {
  if (!exists(from) || !exists(to) || from == to || !factorise()) return std::nullopt;
  const Eigen::Isometry3d T_from_to = T_map_submap(from).inverse() * T_map_submap(to);
  const RelativePoseError e = linearised_relative_pose(T_map_submap(from), T_map_submap(to), T_from_to);
  return system_.marginal({from, e.by_from}, {to, e.by_to});
}

}  // namespace isobar
