// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/graph/pose_graph.hpp"
#include "core/so3.hpp"
#include "tests/core/graph/simulated_building.hpp"

namespace isobar::test::test_loop_selection {

namespace {

constexpr double kUnmovedM = 1e-3;  // what a wrong loop may move a node by

// A loop between two nodes that is off by a shift in the map.
RelativePoseEdge shifted_loop(const Building& building, int from, int to, const Eigen::Vector3d& shift_m) {
  const Eigen::Isometry3d& T_from = building.T_map_submap[static_cast<std::size_t>(from)];
  const Eigen::Isometry3d& T_to = building.T_map_submap[static_cast<std::size_t>(to)];
  return {from, to, T_from.inverse() * Eigen::Translation3d(shift_m) * T_to,
          diagonal_covariance(0.02, 0.02, 1.7e-3), EdgeKind::kLoop};
}

int wrong_taken(const PoseGraph& graph, const Building& building, const std::vector<int>& numbers) {
  int count = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool right = building.loop_right[static_cast<std::size_t>(numbers[i])];
    count += !right && graph.loops()[i].weight > 0.0 ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("a wrong loop to a stacked floor, or 20 m off, moves no node") {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    BuildingOptions options;
    options.seed = seed;
    const Building building = make_building(options);
    PoseGraph without;
    add_drive(building, 0, options.nodes, without);
    add_loops(building, 0, options.nodes, true, false, without);
    without.optimise();
    for (const Eigen::Vector3d& shift_m :
         {Eigen::Vector3d(0.0, 0.0, kFloorHeightM), Eigen::Vector3d(20.0, 0.0, 0.0)}) {
      PoseGraph with;
      add_drive(building, 0, options.nodes, with);
      add_loops(building, 0, options.nodes, true, false, with);
      REQUIRE(with.add_edge(shifted_loop(building, 45, 630, shift_m)));
      const GraphResult result = with.optimise();
      CHECK(result.loops_taken == options.right_loops);
      CHECK(with.loops().back().weight == 0.0);
      CHECK(with.loops().back().chi_square > 2.0 * with.loops().back().gate);
      CHECK(largest_distance_m(with, without) < kUnmovedM);
    }
  }
}

TEST_CASE("wrong loops that agree with each other are rejected together where they contradict the chain") {
  BuildingOptions options;
  options.right_loops = 0;
  const Building building = make_building(options);
  PoseGraph without;
  add_drive(building, 0, options.nodes, without);
  without.optimise();
  for (const Eigen::Vector3d& shift_m :
       {Eigen::Vector3d(0.0, 0.0, kFloorHeightM), Eigen::Vector3d(20.0, 0.0, 0.0)}) {
    PoseGraph with;
    add_drive(building, 0, options.nodes, with);
    for (int i = 0; i < 40; ++i) REQUIRE(with.add_edge(shifted_loop(building, 20 + i, 650 + i, shift_m)));
    CHECK(with.optimise().loops_taken == 0);
    CHECK(largest_distance_m(with, without) < kUnmovedM);
  }
}

TEST_CASE("a wrong loop that the chain allows is taken alone, and given up when right ones contradict it") {
  BuildingOptions options;
  options.altitude = false;
  options.right_loops = 0;
  BuildingNoise noise;
  noise.odometry_m = 0.1;  // 3 m after 900 edges
  const Building building = make_building(options, noise);
  PoseGraph graph;
  add_drive(building, 0, options.nodes, graph);
  REQUIRE(graph.add_edge(shifted_loop(building, 45, 945, {2.0, 0.0, 0.0})));
  CHECK(graph.optimise().loops_taken == 1);
  for (const int node : {40, 50, 60})
    REQUIRE(graph.add_edge(shifted_loop(building, node, node + 900, {0.0, 0.0, 0.0})));
  CHECK(graph.optimise().loops_taken == 3);
  CHECK(graph.loops()[0].weight == 0.0);
  // Between nodes 60 and 945 the chain has three right loops: 10 m of it are open, sqrt(5) 0.1 m.
  const Eigen::Vector3d gap = graph.T_map_submap(945).translation() - graph.T_map_submap(45).translation() -
                              building.T_map_submap[945].translation() +
                              building.T_map_submap[45].translation();
  CHECK(gap.norm() < 1.0);
}

TEST_CASE("of 200 loops over 10000 nodes, the wrong fifth is rejected and the others are taken") {
  BuildingOptions options;
  options.nodes = 10000;
  options.right_loops = 160;
  options.wrong_loops = 40;
  const Building building = make_building(options);
  PoseGraph without;
  PoseGraph with;
  for (PoseGraph* graph : {&with, &without}) add_drive(building, 0, options.nodes, *graph);
  add_loops(building, 0, options.nodes, true, false, without);
  const std::vector<int> numbers = add_loops(building, 0, options.nodes, true, true, with);
  REQUIRE(numbers.size() == 200);
  const GraphResult result = with.optimise();
  without.optimise();
  CHECK(result.converged);
  CHECK(result.loops_taken == options.right_loops);
  CHECK(wrong_taken(with, building, numbers) == 0);
  CHECK(largest_distance_m(with, without) < kUnmovedM);
}

TEST_CASE("a candidate is judged as it would be after it was added, and the graph stays as it is") {
  BuildingOptions options;
  const Building building = make_building(options);
  PoseGraph graph;
  add_drive(building, 0, options.nodes, graph);
  graph.optimise();
  for (const double shift_m : {0.0, 0.5, 20.0}) {
    const RelativePoseEdge loop = shifted_loop(building, 45, 630, {shift_m, 0.0, 0.0});
    const auto before = graph.judge(loop);
    REQUIRE(before.has_value());
    CHECK(graph.loops().empty());
    PoseGraph with;
    add_drive(building, 0, options.nodes, with);
    REQUIRE(with.add_edge(loop));
    with.optimise();
    CHECK(before->weight == with.loops()[0].weight);
    // One is linearised at the open chain, the other one at the closed chain where the loop is taken.
    CHECK(before->chi_square == doctest::Approx(with.loops()[0].chi_square).epsilon(0.1));
  }
  RelativePoseEdge none = shifted_loop(building, 45, 630, {0.0, 0.0, 0.0});
  none.to = options.nodes;
  CHECK_FALSE(graph.judge(none).has_value());
}

TEST_CASE("the only tie of a second part of the graph is taken, wherever that part believed to be") {
  BuildingOptions options;
  options.nodes = 100;
  options.right_loops = 0;
  const Building building = make_building(options);
  PoseGraph graph;
  add_drive(building, 0, 50, graph);
  for (int n = 50; n < 100; ++n) {
    Eigen::Isometry3d T = building.T_map_submap[static_cast<std::size_t>(n)];
    T.translation() += Eigen::Vector3d(30.0, 5.0, 2.0);
    REQUIRE(graph.add_node({T, true, 0}));
    if (n > 50) REQUIRE(graph.add_edge(building.odometry[static_cast<std::size_t>(n - 1)]));
  }
  REQUIRE(graph.add_edge(shifted_loop(building, 20, 70, {0.0, 0.0, 0.0})));
  const GraphResult result = graph.optimise();
  CHECK(result.converged);
  CHECK(result.loops_taken == 1);
  CHECK(rms_error_m(graph, building) < 0.2);  // drift over 50 edges of 1 cm
  graph.optimise();
  CHECK(graph.loops()[0].weight == 1.0);
}

TEST_CASE("verdicts and poses do not depend on the order of the loops") {
  BuildingOptions options;
  options.right_loops = 30;
  options.wrong_loops = 10;
  Building building = make_building(options);
  PoseGraph first;
  add_drive(building, 0, options.nodes, first);
  add_loops(building, 0, options.nodes, true, true, first);
  first.optimise();
  std::vector<std::size_t> order(building.loops.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::mt19937 random(2);
  std::shuffle(order.begin(), order.end(), random);
  PoseGraph second;
  add_drive(building, 0, options.nodes, second);
  for (const std::size_t i : order) REQUIRE(second.add_edge(building.loops[i]));
  second.optimise();
  for (std::size_t i = 0; i < order.size(); ++i)
    CHECK(second.loops()[i].weight == first.loops()[order[i]].weight);
  CHECK(largest_distance_m(first, second) < 1e-5);  // last steps are below 1e-6
}

}  // namespace isobar::test::test_loop_selection
