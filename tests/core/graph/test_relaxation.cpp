// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <random>
#include <vector>

#include "core/graph/graph_factors.hpp"
#include "core/graph/loop_selection.hpp"
#include "core/graph/relaxation.hpp"
#include "core/graph/whitening.hpp"
#include "core/so3.hpp"
#include "tests/core/graph/simulated_building.hpp"

namespace isobar::test::test_relaxation {

namespace {

WhitenedEdge edge_of(NodeId from, NodeId to, const Eigen::Isometry3d& T_from_to, double sigma_m,
                     double sigma_rad) {
  const Matrix6d covariance = diagonal_covariance(sigma_m, sigma_m, sigma_rad);
  return {{from, to, T_from_to, covariance, EdgeKind::kOdometry}, *whitening(covariance, true), true};
}

}  // namespace

// Positions that are known well and headings that only they tell: far from linear.
TEST_CASE("no step raises the sum of squares, from positions and headings that are any") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  for (int start = 0; start < 10; ++start) {
    GraphFactors factors;
    GraphState state;
    Eigen::Isometry3d T_step = Eigen::Isometry3d::Identity();
    T_step.linear() = rotation_about_z(0.3);
    T_step.translation().x() = 2.0;
    for (int n = 0; n < 20; ++n) {
      GraphNode node;
      if (n > 0) node.T_map_submap.linear() = rotation_about_z(any(random));
      if (n > 0) node.T_map_submap.translation() << any(random), any(random), 0.0;
      state.nodes.push_back(node);
      state.bias_m.push_back(0.0);
      if (n > 0) factors.odometry.push_back(edge_of(n - 1, n, T_step, 0.01, 10.0));
    }
    factors.odometry.push_back(edge_of(0, 19, Eigen::Isometry3d::Identity(), 0.01, 10.0));
    factors.anchors = {0};
    NormalSystem system;
    restructure(state.nodes, factors, system);
    double before = chi_square(factors, {}, state);
    for (int step = 0; step < 20; ++step) {
      RelaxationLimits few;
      few.iterations = 3;  // a step, and two with more damping where it is refused
      const Relaxation result = relax(factors, {}, few, system, state);
      CHECK(result.chi_square <= (1.0 + 1e-6) * before + 1e-9);  // rounding
      CHECK(result.chi_square == chi_square(factors, {}, state));
      before = result.chi_square;
    }
  }
}

TEST_CASE("the only tie of a node does not contradict itself by the rounding of the last step") {
  GraphFactors factors;
  factors.loops = {edge_of(0, 1, Eigen::Isometry3d::Identity(), 1e-3, 1e-3)};
  GraphState state{std::vector<GraphNode>(2), {0.0, 0.0}};
  state.nodes[1].T_map_submap.translation().x() = 1e-7;  // a tenth of the limit of a step
  NormalSystem system;
  restructure(state.nodes, factors, system);
  linearise(factors, {1}, state, system);
  REQUIRE(system.factorise(0.0));
  CHECK(loop_distance(factors.loops[0], true, state, system) < 2.0);
}

}  // namespace isobar::test::test_relaxation
