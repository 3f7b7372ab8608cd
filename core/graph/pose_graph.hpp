// SPDX-License-Identifier: BSD-3-Clause
// Pose graph of a building: submap poses, odometry between them, loops, altitudes, ground and priors.
//
// Not for the way of a scan: optimise() takes up to seconds and allocates. One thread owns a graph. The result depends on
// the calls alone: two graphs built alike are bit-identical.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/graph/altitude_factor.hpp"
#include "core/graph/graph_factors.hpp"
#include "core/graph/graph_node.hpp"
#include "core/graph/loop_selection.hpp"
#include "core/graph/normal_system.hpp"
#include "core/graph/pose_prior.hpp"
#include "core/graph/relative_pose_edge.hpp"
#include "core/graph/relaxation.hpp"
#include "core/graph/stationary_ground.hpp"

namespace isobar {

/// Settings of a pose graph.
struct PoseGraphConfig {
  AltimeterBias bias;
  LoopGate loops;
  RelaxationLimits limits;
};

/// A loop after optimise().
struct LoopVerdict {
  double weight = 0.0;  ///< 1: taken into account, 0: rejected, or not optimised yet
  double chi_square =
      0.0;            ///< squared distance from what the rest of the graph predicts, over both variances
  double gate = 0.0;  ///< largest chi_square of a right loop
};

/// Result of optimise().
struct GraphResult {
  bool converged = false;   ///< false: the poses are the best so far
  int iterations = 0;       ///< factorisations
  double chi_square = 0.0;  ///< sum of all squared errors over their variances, rejected loops not included
  int loops_taken = 0;
};

/// Pose graph. Calls that return false have refused an input (a node that does not exist, a number that is not finite or
/// beyond 1e7 m, a covariance that is not positive definite, a sigma below kLeastSigma) and changed nothing.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config = {});

  /// Adds a node at its present estimate.
  /// @return its number; nothing where the pose is not finite or not a rotation
  std::optional<NodeId> add_node(const GraphNode& node);
  /// Adds an edge between two different nodes. Loops are numbered in the order of addition, for loops().
  [[nodiscard]] bool add_edge(const RelativePoseEdge& edge);
  [[nodiscard]] bool add_altitude(const AltitudeFactor& factor);
  [[nodiscard]] bool add_stationary_ground(const StationaryGround& factor);
  [[nodiscard]] bool add_prior(const PosePrior& prior);
  /// Keeps a node where it is, exactly. Without anchor and prior the first node is kept.
  [[nodiscard]] bool anchor(NodeId node);

  /// Moves the nodes to the minimum, from their present estimates, and judges all loops anew. Nodes that nothing ties to an
  /// anchor or prior stay where they are relative to each other.
  GraphResult optimise();

  [[nodiscard]] std::span<const GraphNode> nodes() const { return state_.nodes; }
  // NOLINTNEXTLINE(readability-identifier-naming)
  [[nodiscard]] const Eigen::Isometry3d& T_map_submap(NodeId node) const {
    return state_.nodes[static_cast<std::size_t>(node)].T_map_submap;
  }
  /// Altimeter minus height at a node [m]; zero where it has no altitude.
  [[nodiscard]] double bias_m(NodeId node) const { return state_.bias_m[static_cast<std::size_t>(node)]; }
  [[nodiscard]] std::span<const LoopVerdict> loops() const { return verdicts_; }
  [[nodiscard]] const RelativePoseEdge& loop(int number) const {
    return factors_.loops[static_cast<std::size_t>(number)].edge;
  }

  /// Covariance of the relative pose T_from_to of two different nodes, as RelativePoseEdge::covariance: the marginal of the
  /// whole graph with the loops that are taken, at the present estimates. Roll and pitch between nodes held by gravity are
  /// zero, but for the tilt of `from`. Cheap, but the first call after an addition factorises the graph.
  /// @return nothing where a node does not exist, both are the same, or the graph cannot be factorised
  std::optional<Matrix6d> relative_covariance(NodeId from, NodeId to);
  /// What the graph says of a loop that it does not have: weight 1 where it predicts the loop within the gate. As cheap.
  /// @return nothing where add_edge() would refuse the loop, or the graph cannot be factorised
  std::optional<LoopVerdict> judge(const RelativePoseEdge& candidate);

 private:
  [[nodiscard]] bool exists(NodeId node) const {
    return node >= 0 && static_cast<std::size_t>(node) < state_.nodes.size();
  }
  [[nodiscard]] bool held(NodeId node) const {
    return state_.nodes[static_cast<std::size_t>(node)].held_by_gravity;
  }
  [[nodiscard]] std::optional<WhitenedEdge> whitened(const RelativePoseEdge& edge) const;
  bool changed();
  void rebuild();
  bool factorise();
  GraphResult report(const LoopSelection& selection, const Relaxation& relaxation);

  PoseGraphConfig config_;
  GraphState state_;
  GraphFactors factors_;
  LoopWeights taken_;
  std::vector<LoopVerdict> verdicts_;
  NormalSystem system_;
  bool structure_changed_ = true;  // something was added since system_ was built
  bool factorised_ = false;        // system_ is that of the present estimates and loops
};

}  // namespace isobar
