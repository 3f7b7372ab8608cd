// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/graph_factors.hpp"

#include <algorithm>

namespace isobar {

namespace {

using OneError = Eigen::Matrix<double, 1, 1>;

const GraphNode& node_at(const GraphState& state, NodeId node) {
  return state.nodes[static_cast<std::size_t>(node)];
}

double height_at(const GraphState& state, NodeId node) {
  return node_at(state, node).T_map_submap.translation().z();
}

double bias_at(const GraphState& state, NodeId node) { return state.bias_m[static_cast<std::size_t>(node)]; }

Vector6d edge_error(const WhitenedEdge& edge, const GraphState& state) {
  return edge.whitening * relative_pose_error(node_at(state, edge.edge.from).T_map_submap,
                                              node_at(state, edge.edge.to).T_map_submap, edge.edge.T_from_to);
}

void add_edge_to(const WhitenedEdge& edge, const GraphState& state, NormalSystem& system) {
  const RelativePoseError e = whitened_error(edge, state);
  system.add<6>(e.error, {edge.edge.from, e.by_from}, {edge.edge.to, e.by_to});
}

/// Change of the bias from the chain's node `at` - 1 to `at`.
BiasLink link_to(const GraphFactors& factors, const GraphState& state, std::size_t at) {
  // As numbers that cannot overflow, whatever the stamps; exact to 256 ns.
  const auto stamp_ns = [&](std::size_t i) {
    return static_cast<double>(node_at(state, factors.bias_chain[i]).stamp_ns);
  };
  return bias_link(factors.bias, 1e-9 * (stamp_ns(at) - stamp_ns(at - 1)));
}

double bias_chi_square(const GraphFactors& factors, const GraphState& state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < factors.bias_chain.size(); ++i) {
    const double here_m = bias_at(state, factors.bias_chain[i]);
    sum += i == 0 ? squared(here_m / factors.bias.start_sigma_m)
                  : squared(bias_error(link_to(factors, state, i), bias_at(state, factors.bias_chain[i - 1]),
                                       here_m));
  }
  return sum;
}

void linearise_biases(const GraphFactors& factors, const GraphState& state, NormalSystem& system) {
  for (std::size_t i = 0; i < factors.bias_chain.size(); ++i) {
    const NodeId here = factors.bias_chain[i];
    if (i == 0) {
      const double per_sigma = 1.0 / factors.bias.start_sigma_m;
      system.add<1>(OneError(bias_at(state, here) * per_sigma), {here, bias_jacobian(per_sigma)});
      continue;
    }
    const NodeId before = factors.bias_chain[i - 1];
    const BiasLink link = link_to(factors, state, i);
    const OneError error(bias_error(link, bias_at(state, before), bias_at(state, here)));
    system.add<1>(error, {before, bias_jacobian(-link.phi / link.sigma_m)},
                  {here, bias_jacobian(1.0 / link.sigma_m)});
  }
}

}  // namespace

void order_biases(const std::vector<GraphNode>& nodes, GraphFactors& factors) {
  std::vector<NodeId>& chain = factors.bias_chain;
  chain.clear();
  for (const AltitudeFactor& altitude : factors.altitudes) chain.push_back(altitude.node);
  const auto stamp = [&](NodeId node) { return nodes[static_cast<std::size_t>(node)].stamp_ns; };
  std::sort(chain.begin(), chain.end(),
            [&](NodeId a, NodeId b) { return std::pair(stamp(a), a) < std::pair(stamp(b), b); });
  chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
}

void restructure(const std::vector<GraphNode>& nodes, const GraphFactors& factors, NormalSystem& system) {
  std::vector<std::uint8_t> anchored(nodes.size(), 0);
  std::vector<std::uint8_t> has_bias(nodes.size(), 0);
  for (const NodeId node : factors.anchors) anchored[static_cast<std::size_t>(node)] = 1;
  if (factors.anchors.empty() && factors.priors.empty() && !nodes.empty()) anchored[0] = 1;
  for (const NodeId node : factors.bias_chain) has_bias[static_cast<std::size_t>(node)] = 1;
  std::vector<NodeFreedom> freedom;
  freedom.reserve(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    freedom.push_back(freedom_of(anchored[n] != 0, nodes[n].held_by_gravity, has_bias[n] != 0));
  }
  std::vector<NodePair> ties;
  for (const WhitenedEdge& e : factors.odometry) ties.emplace_back(e.edge.from, e.edge.to);
  for (const WhitenedEdge& e : factors.loops) ties.emplace_back(e.edge.from, e.edge.to);
  for (const StationaryGround& ground : factors.grounds) ties.emplace_back(ground.a, ground.b);
  for (std::size_t i = 1; i < factors.bias_chain.size(); ++i) {
    ties.emplace_back(factors.bias_chain[i - 1], factors.bias_chain[i]);
  }
  system.restructure(std::move(freedom), ties);
}

double chi_square(const GraphFactors& factors, const LoopWeights& loops, const GraphState& state) {
  double sum = bias_chi_square(factors, state);
  for (const WhitenedEdge& edge : factors.odometry) sum += edge_error(edge, state).squaredNorm();
  for (std::size_t i = 0; i < factors.loops.size(); ++i) {
    if (loops[i] != 0) sum += edge_error(factors.loops[i], state).squaredNorm();
  }
  for (const WhitenedPrior& p : factors.priors) {
    const Eigen::Isometry3d& T = node_at(state, p.prior.node).T_map_submap;
    sum += (p.whitening * prior_error(T, p.prior.T_map_submap)).squaredNorm();
  }
  for (const AltitudeFactor& altitude : factors.altitudes) {
    sum += squared(altitude_error(altitude, height_at(state, altitude.node), bias_at(state, altitude.node)));
  }
  for (const StationaryGround& ground : factors.grounds) {
    sum += squared(ground_error(ground, height_at(state, ground.a), height_at(state, ground.b)));
  }
  return sum;
}

void linearise(const GraphFactors& factors, const LoopWeights& loops, const GraphState& state,
               NormalSystem& system) {
  system.clear();
  for (const WhitenedEdge& edge : factors.odometry) add_edge_to(edge, state, system);
  for (std::size_t i = 0; i < factors.loops.size(); ++i) {
    if (loops[i] != 0) add_edge_to(factors.loops[i], state, system);
  }
  for (const WhitenedPrior& p : factors.priors) {
    const Vector6d error = prior_error(node_at(state, p.prior.node).T_map_submap, p.prior.T_map_submap);
    const NodeJacobian<6> J = p.whitening * prior_jacobian(error);
    system.add<6>(p.whitening * error, {p.prior.node, J});
  }
  for (const AltitudeFactor& altitude : factors.altitudes) {
    const double z_m = height_at(state, altitude.node);
    const OneError error(altitude_error(altitude, z_m, bias_at(state, altitude.node)));
    system.add<1>(error, {altitude.node, altitude_jacobian(altitude)});
  }
  for (const StationaryGround& ground : factors.grounds) {
    const OneError error(ground_error(ground, height_at(state, ground.a), height_at(state, ground.b)));
    const NodeJacobian<1> J = ground_jacobian(ground);
    system.add<1>(error, {ground.a, J}, {ground.b, -J});
  }
  linearise_biases(factors, state, system);
}

RelativePoseError whitened_error(const WhitenedEdge& edge, const GraphState& state) {
  RelativePoseError e =
      linearised_relative_pose(node_at(state, edge.edge.from).T_map_submap,
                               node_at(state, edge.edge.to).T_map_submap, edge.edge.T_from_to);
  e.error = edge.whitening * e.error;
  e.by_from = edge.whitening * e.by_from;
  e.by_to = edge.whitening * e.by_to;
  return e;
}

}  // namespace isobar
