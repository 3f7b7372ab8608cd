// SPDX-License-Identifier: BSD-3-Clause
// Graphs that grow, weather, floors, and second sessions.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/graph/pose_graph.hpp"
#include "core/so3.hpp"
#include "tests/core/graph/simulated_building.hpp"

namespace isobar::test::test_graph_sessions {

namespace {

// Laps of one floor with an altimeter whose bias drifts as the weather does.
struct Weather {
  Building building;
  std::vector<double> bias_m;
};

Weather weather_on_a_floor(double drift_m) {
  BuildingOptions options;
  options.nodes = 270;  // three laps, all on floor 0
  options.right_loops = 10;
  Weather out{make_building(options), {}};
  for (int n = 0; n < options.nodes; ++n) {
    const auto at = static_cast<std::size_t>(n);
    out.bias_m.push_back(drift_m * n / options.nodes);
    out.building.altitudes[at].height_m += out.bias_m.back() - out.building.bias_m[at];
    out.building.stamp_ns[at] *= 6;  // 54 min
  }
  return out;
}

}  // namespace

TEST_CASE("a graph that grows ends like one that is optimised once") {
  BuildingOptions options;
  options.nodes = 1200;
  options.right_loops = 30;
  options.wrong_loops = 8;
  const Building building = make_building(options);
  PoseGraph batch;
  add_drive(building, 0, options.nodes, batch);
  const std::vector<int> order = add_loops(building, 0, options.nodes, true, true, batch);
  batch.optimise();
  PoseGraph growing;
  std::vector<int> grown;
  for (int begin = 0; begin < options.nodes; begin += 100) {
    add_drive(building, begin, begin + 100, growing);
    for (const int i : add_loops(building, begin, begin + 100, true, true, growing)) grown.push_back(i);
    growing.optimise();
  }
  REQUIRE(grown.size() == order.size());
  for (std::size_t i = 0; i < grown.size(); ++i) {
    const auto in_batch =
        static_cast<std::size_t>(std::find(order.begin(), order.end(), grown[i]) - order.begin());
    CHECK(growing.loops()[i].weight == batch.loops()[in_batch].weight);
    CHECK(growing.loops()[i].chi_square == doctest::Approx(batch.loops()[in_batch].chi_square).epsilon(1e-3));
  }
  CHECK(largest_distance_m(batch, growing) < 1e-5);  // last steps are below 1e-6
}

TEST_CASE("the bias takes the weather's drift, and the floor stays level") {
  for (const double drift_m : {0.3, 3.0}) {
    PoseGraphConfig config;
    if (drift_m > 1.0) config.bias.weather_walk_m_sqrt_s = 0.02;  // without a base station
    const Weather weather = weather_on_a_floor(drift_m);
    PoseGraph graph(config);
    add_drive(weather.building, 0, 270, graph);
    add_loops(weather.building, 0, 270, true, false, graph);
    REQUIRE(graph.anchor(0));
    CHECK(graph.optimise().loops_taken == 10);
    for (int n = 1; n < 270; ++n) {
      // 4 sigma of the height by the graph's own account: the drift adds nothing to it.
      const double sigma_m = std::sqrt((*graph.relative_covariance(0, n))(2, 2));
      CHECK(std::abs(graph.T_map_submap(n).translation().z()) < 4.0 * sigma_m);
      CHECK(sigma_m < 0.05);
      // The bias is known as well as the height, and a reading's noise of 5 cm over its neighbours.
      CHECK(std::abs(graph.bias_m(n) - weather.bias_m[static_cast<std::size_t>(n)]) < 0.15);
    }
  }
}

TEST_CASE("ground that does not move makes one height of two, by the sigmas of both") {
  PoseGraph graph;
  const Matrix6d covariance = diagonal_covariance(0.1, 0.1, 0.01);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  REQUIRE(graph.add_node({T, true, 0}));
  T.translation() << 5.0, 0.0, 0.3;
  REQUIRE(graph.add_node({T, true, 1}));
  REQUIRE(graph.add_edge({0, 1, T, covariance}));
  REQUIRE(graph.add_stationary_ground({0, 1, 0.05}));
  graph.optimise();
  // Weighted mean of 0.3 m (0.1 m) and 0 m (0.05 m).
  CHECK(graph.T_map_submap(1).translation().z() ==
        doctest::Approx(0.3 * 0.05 * 0.05 / (0.05 * 0.05 + 0.1 * 0.1)));
}

TEST_CASE(
    "a prior and an edge share a node by their covariances; without an anchor the prior holds the graph") {
  PoseGraph graph;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  REQUIRE(graph.add_node({T, true, 0}));
  T.translation().x() = 4.0;
  REQUIRE(graph.add_node({T, true, 1}));
  REQUIRE(graph.add_edge({0, 1, T, diagonal_covariance(0.1, 0.1, 1e-3)}));
  Eigen::Isometry3d T_known = Eigen::Isometry3d::Identity();
  REQUIRE(graph.add_prior({0, T_known, diagonal_covariance(0.1, 0.1, 1e-3)}));
  T_known.translation().x() = 4.3;
  REQUIRE(graph.add_prior({1, T_known, diagonal_covariance(0.1, 0.1, 1e-3)}));
  graph.optimise();
  CHECK(graph.T_map_submap(0).translation().x() == doctest::Approx(0.1));  // three equal springs
  CHECK(graph.T_map_submap(1).translation().x() == doctest::Approx(4.2));
}

TEST_CASE("a second session that begins elsewhere comes into the frame of the first by its loops") {
  BuildingOptions options;
  options.noise = false;
  options.nodes = 540;
  options.right_loops = 60;
  const Building building = make_building(options);
  PoseGraph graph;
  add_drive(building, 0, 270, graph);
  REQUIRE(graph.anchor(0));
  // The second session believes to start 8 m and 40° off, and has no edge to the first. Its floor is one higher.
  Eigen::Isometry3d T_off = Eigen::Isometry3d::Identity();
  T_off.linear() = rotation_about_z(0.7);
  T_off.translation() << 8.0, -3.0, 1.0;
  for (int n = 270; n < 540; ++n) {
    const auto at = static_cast<std::size_t>(n);
    REQUIRE(graph.add_node(
        {T_off * building.T_map_submap[at], true, building.stamp_ns[at] + 86'400'000'000'000}));
    if (n > 270) REQUIRE(graph.add_edge(building.odometry[at - 1]));
  }
  for (const int to : {300, 350, 400}) {
    const Eigen::Isometry3d T = building.T_map_submap[static_cast<std::size_t>(to - 250)].inverse() *
                                building.T_map_submap[static_cast<std::size_t>(to)];
    REQUIRE(graph.add_edge({to - 250, to, T, diagonal_covariance(0.02, 0.02, 1.7e-3), EdgeKind::kLoop}));
  }
  const GraphResult result = graph.optimise();
  CHECK(result.converged);
  CHECK(result.loops_taken == 3);
  CHECK(rms_error_m(graph, building) < 1e-5);  // converged: last step below 1e-6
}

TEST_CASE("the covariance of two nodes needs no optimise(), follows additions, and shrinks with a loop") {
  BuildingOptions options;
  options.nodes = 270;
  options.right_loops = 5;
  const Building building = make_building(options);
  PoseGraph graph;
  add_drive(building, 0, 200, graph);
  REQUIRE(graph.relative_covariance(0, 199).has_value());
  add_drive(building, 200, 270, graph);
  const Matrix6d open = *graph.relative_covariance(20, 200);
  REQUIRE(graph.add_edge({20, 200, building.T_map_submap[20].inverse() * building.T_map_submap[200],
                          diagonal_covariance(0.02, 0.02, 1.7e-3), EdgeKind::kLoop}));
  CHECK((*graph.relative_covariance(20, 200) - open).norm() < 1e-9);  // not taken yet
  REQUIRE(graph.optimise().loops_taken == 1);
  const Matrix6d closed = *graph.relative_covariance(20, 200);
  // Two independent measurements: the chain's and the loop's.
  for (const int row : {0, 1, 2}) {
    CHECK(closed(row, row) < 0.02 * 0.02);
    CHECK(closed(row, row) < open(row, row));
  }
}

}  // namespace isobar::test::test_graph_sessions
