// SPDX-License-Identifier: BSD-3-Clause
// All factors of a pose graph: their sum of squares and their normal equations.
#pragma once

#include <cstdint>
#include <vector>

#include "core/graph/altitude_factor.hpp"
#include "core/graph/graph_node.hpp"
#include "core/graph/normal_system.hpp"
#include "core/graph/pose_prior.hpp"
#include "core/graph/relative_pose_edge.hpp"
#include "core/graph/stationary_ground.hpp"

namespace isobar {

/// Edge with its whitening.
struct WhitenedEdge {
  RelativePoseEdge edge;
  Matrix6d whitening;
  bool level = false;  ///< both nodes are held by gravity: four rows count
};

/// Prior with its whitening.
struct WhitenedPrior {
  PosePrior prior;
  Matrix6d whitening;
};

/// Loops that are taken into account: 1, or left out: 0; one a loop.
using LoopWeights = std::vector<std::uint8_t>;

/// Factors of a graph.
struct GraphFactors {
  AltimeterBias bias;
  std::vector<WhitenedEdge> odometry;
  std::vector<WhitenedEdge> loops;
  std::vector<WhitenedPrior> priors;
  std::vector<AltitudeFactor> altitudes;
  std::vector<StationaryGround> grounds;
  std::vector<NodeId> anchors;
  std::vector<NodeId>
      bias_chain;  ///< nodes with an altitude, in the order of their stamps; see order_biases()
};

/// Sets GraphFactors::bias_chain.
void order_biases(const std::vector<GraphNode>& nodes, GraphFactors& factors);

/// Gives `system` the structure of these factors. Where nothing holds the graph in the map, its first node is anchored.
void restructure(const std::vector<GraphNode>& nodes, const GraphFactors& factors, NormalSystem& system);

/// Sum of the squared, whitened errors.
double chi_square(const GraphFactors& factors, const LoopWeights& loops, const GraphState& state);

/// Sets `system` to the normal equations at `state`.
void linearise(const GraphFactors& factors, const LoopWeights& loops, const GraphState& state,
               NormalSystem& system);

/// Error and Jacobians of an edge, whitened.
RelativePoseError whitened_error(const WhitenedEdge& edge, const GraphState& state);

}  // namespace isobar
