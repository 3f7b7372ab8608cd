// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "core/graph/pose_graph.hpp"
#include "core/so3.hpp"
#include "tests/core/graph/simulated_building.hpp"

namespace isobar::test::test_pose_graph {

namespace {

// The last step of a position is below 1e-6 m and that of Gauss-Newton much smaller than the one before it.
constexpr double kConvergedM = 1e-5;

Eigen::Isometry3d pose(double x_m, double y_m, double z_m, double yaw_rad = 0.0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_about_z(yaw_rad);
  T.translation() << x_m, y_m, z_m;
  return T;
}

// Nodes of a building at poses that are 1 m and 0.1 rad off, with all edges.
void add_disturbed(const Building& building, PoseGraph& graph) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (std::size_t n = 0; n < building.T_map_submap.size(); ++n) {
    NodeStep off;
    for (double& value : off) value = normal(random);
    off.segment<3>(3) *= 0.1;
    if (building.held_by_gravity) off.segment<2>(3).setZero();
    if (n == 0) off.setZero();
    REQUIRE(graph.add_node(
        {moved(building.T_map_submap[n], off), building.held_by_gravity, building.stamp_ns[n]}));
  }
  for (const RelativePoseEdge& edge : building.odometry) REQUIRE(graph.add_edge(edge));
  for (const RelativePoseEdge& edge : building.loops) REQUIRE(graph.add_edge(edge));
  for (const AltitudeFactor& altitude : building.altitudes) REQUIRE(graph.add_altitude(altitude));
}

// n edges of 1 m around a square of n / 4 m a side, that end `off` from where they began, and a loop that says so.
void add_square(int n, const Eigen::Vector3d& off_m, const Matrix6d& edge_covariance,
                const Matrix6d& loop_covariance, PoseGraph& graph) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  REQUIRE(graph.add_node({T, true, 0}));
  for (int i = 1; i <= n; ++i) {
    const double turn_rad = i % (n / 4) == 0 ? 0.5 * M_PI : 0.0;
    const Eigen::Isometry3d T_true = pose(1.0, 0.0, 0.0, turn_rad);
    Eigen::Isometry3d T_step = T_true;
    T_step.translation() += T.linear().transpose() * off_m / n;
    T = T * T_step;
    REQUIRE(graph.add_node({T, true, i}));
    REQUIRE(graph.add_edge({i - 1, i, T_step, edge_covariance, EdgeKind::kOdometry}));
  }
  REQUIRE(graph.add_edge({0, n, pose(0.0, 0.0, 0.0, 0.0), loop_covariance, EdgeKind::kLoop}));
}

}  // namespace

TEST_CASE("exact measurements give the truth back, from estimates that are off, with and without gravity") {
  for (const bool held : {true, false}) {
    BuildingOptions options;
    options.noise = false;
    options.nodes = 400;
    options.held_by_gravity = held;
    const Building building = make_building(options);
    PoseGraph graph;
    add_disturbed(building, graph);
    const GraphResult result = graph.optimise();
    CHECK(result.converged);
    CHECK(result.loops_taken == options.right_loops);
    CHECK(result.chi_square < 1e-6);
    double largest = 0.0;
    for (std::size_t n = 0; n < building.T_map_submap.size(); ++n) {
      const auto gap = (graph.nodes()[n].T_map_submap.matrix() - building.T_map_submap[n].matrix()).eval();
      largest = std::max(largest, gap.cwiseAbs().maxCoeff());
    }
    CHECK(largest < kConvergedM);
  }
}

TEST_CASE(
    "the sum of squares is that of errors with the stated covariances: it is the number of measurements too "
    "many") {
  for (const bool held : {true, false}) {
    BuildingOptions options;
    options.held_by_gravity = held;
    const Building building = make_building(options);
    PoseGraph graph;
    add_drive(building, 0, options.nodes, graph);
    add_loops(building, 0, options.nodes, true, true, graph);
    const GraphResult result = graph.optimise();
    REQUIRE(result.loops_taken == options.right_loops);
    const double redundancy = options.nodes + (held ? 4.0 : 6.0) * options.right_loops;
    CHECK(std::abs(result.chi_square - redundancy) < 4.0 * std::sqrt(2.0 * redundancy));  // 4 sigma
    CHECK(rms_error_m(graph, building) < 0.5);
  }
}

TEST_CASE("the result does not depend on where the map has its origin and its axes") {
  BuildingOptions options;
  options.nodes = 600;
  const Building building = make_building(options);
  const Eigen::Isometry3d T_other_map = pose(1000.0, -2000.0, 50.0, 2.5);
  Building other = building;
  for (Eigen::Isometry3d& T : other.T_map_submap) T = T_other_map * T;
  for (AltitudeFactor& altitude : other.altitudes) altitude.height_m += 50.0;
  PoseGraph here;
  PoseGraph there;
  add_disturbed(building, here);
  add_disturbed(other, there);
  here.optimise();
  there.optimise();
  double largest_m = 0.0;
  for (std::size_t n = 0; n < here.nodes().size(); ++n) {
    const Eigen::Isometry3d T = T_other_map.inverse() * there.nodes()[n].T_map_submap;
    largest_m =
        std::max(largest_m, (T.matrix() - here.nodes()[n].T_map_submap.matrix()).cwiseAbs().maxCoeff());
  }
  CHECK(largest_m < kConvergedM);
}

TEST_CASE("a closed loop of n equal edges moves each by the same share of the error") {
  const int n = 80;
  const double sigma_m = 0.02;
  const double loop_sigma_m = 0.01;
  // Headings that are known: then positions add up.
  const Matrix6d edge = diagonal_covariance(sigma_m, sigma_m, 1e-7);
  const Matrix6d loop = diagonal_covariance(loop_sigma_m, loop_sigma_m, 1e-7);
  const Eigen::Vector3d off_m(0.15, -0.25, 0.2);  // 2 sigma of the chain
  PoseGraph graph;
  add_square(n, off_m, edge, loop, graph);
  const GraphResult result = graph.optimise();
  CHECK(result.loops_taken == 1);
  // Series connection of variances: n edges and the loop.
  const double share = sigma_m * sigma_m / (n * sigma_m * sigma_m + loop_sigma_m * loop_sigma_m);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  double largest_m = 0.0;
  for (int i = 1; i <= n; ++i) {
    T = T * pose(1.0, 0.0, 0.0, i % (n / 4) == 0 ? 0.5 * M_PI : 0.0);
    const Eigen::Vector3d expected = T.translation() + i * (1.0 / n - share) * off_m;
    largest_m = std::max(largest_m, (graph.T_map_submap(i).translation() - expected).norm());
  }
  CHECK(largest_m < kConvergedM);
  const double chi_square = off_m.squaredNorm() / (n * sigma_m * sigma_m + loop_sigma_m * loop_sigma_m);
  CHECK(result.chi_square == doctest::Approx(chi_square).epsilon(1e-6));
  CHECK(graph.loops()[0].chi_square ==
        doctest::Approx(chi_square).epsilon(1e-4));  // the loop against the chain
}

TEST_CASE("gravity holds roll and pitch; without it loops may turn them") {
  for (const bool held : {true, false}) {
    BuildingOptions options;
    options.nodes = 300;
    options.held_by_gravity = held;
    const Building building = make_building(options);
    PoseGraph graph;
    add_drive(building, 0, options.nodes, graph);
    std::vector<Eigen::Vector3d> up;
    for (const GraphNode& node : graph.nodes()) up.emplace_back(node.T_map_submap.linear().row(2));
    add_loops(building, 0, options.nodes, true, false, graph);
    graph.optimise();
    double largest = 0.0;
    for (std::size_t n = 0; n < up.size(); ++n) {
      largest = std::max(largest, (graph.nodes()[n].T_map_submap.linear().row(2).transpose() - up[n]).norm());
    }
    if (held) CHECK(largest < 1e-14);
    if (!held) CHECK(largest > 1e-4);
  }
}

TEST_CASE("altitudes and priors of infinite sigma change nothing") {
  BuildingOptions options;
  options.nodes = 400;
  const Building building = make_building(options);
  PoseGraph with;
  PoseGraph without;
  for (PoseGraph* graph : {&with, &without}) {
    Building drive = building;
    if (graph == &without) drive.altitudes.clear();
    for (AltitudeFactor& altitude : drive.altitudes) {
      altitude.sigma_m = 1e9;
      altitude.height_m += 5.0;
    }
    add_drive(drive, 0, options.nodes, *graph);
    add_loops(drive, 0, options.nodes, true, false, *graph);
    REQUIRE(graph->anchor(0));
  }
  REQUIRE(with.add_prior({100, pose(9.0, 9.0, 9.0, 1.0), diagonal_covariance(1e9, 1e9, 1e9)}));
  with.optimise();
  without.optimise();
  CHECK(largest_distance_m(with, without) < kConvergedM);
}

TEST_CASE("the same calls give the same bits") {
  BuildingOptions options;
  options.wrong_loops = 5;
  const Building building = make_building(options);
  PoseGraph first;
  PoseGraph second;
  for (PoseGraph* graph : {&first, &second}) {
    add_drive(building, 0, options.nodes, *graph);
    add_loops(building, 0, options.nodes, true, true, *graph);
    graph->optimise();
  }
  bool same = true;
  for (int n = 0; n < options.nodes; ++n) {
    same = same && first.T_map_submap(n).matrix() == second.T_map_submap(n).matrix() &&
           first.bias_m(n) == second.bias_m(n);
  }
  CHECK(same);
  CHECK(*first.relative_covariance(10, 900) == *second.relative_covariance(10, 900));
}

TEST_CASE("the relative covariance of a chain is the sum over its edges, wherever it begins") {
  const int n = 20;
  const double sigma_m = 0.02;
  const double sigma_rad = 1e-3;
  PoseGraph graph;
  for (int i = 0; i <= 2 * n; ++i) {
    REQUIRE(graph.add_node({pose(i, 0.0, 0.0), true, i}));
    if (i > 0) {
      REQUIRE(
          graph.add_edge({i - 1, i, pose(1.0, 0.0, 0.0), diagonal_covariance(sigma_m, sigma_m, sigma_rad)}));
    }
  }
  double lever_m2 = 0.0;  // the turn of edge k moves the n - k nodes after it
  for (int k = 1; k <= n; ++k) lever_m2 += squared(n - k);
  for (const int begin : {0, 7, n}) {
    const Matrix6d covariance = *graph.relative_covariance(begin, begin + n);
    const double along_m2 = n * squared(sigma_m);
    CHECK(covariance(0, 0) == doctest::Approx(along_m2).epsilon(1e-6));
    CHECK(covariance(1, 1) == doctest::Approx(along_m2 + squared(sigma_rad) * lever_m2).epsilon(1e-6));
    CHECK(covariance(2, 2) == doctest::Approx(along_m2).epsilon(1e-6));
    CHECK(covariance(5, 5) == doctest::Approx(n * squared(sigma_rad)).epsilon(1e-6));
    CHECK(covariance(1, 5) == doctest::Approx(squared(sigma_rad) * n * (n - 1) / 2.0).epsilon(1e-6));
  }
}

TEST_CASE("input that is not a measurement is refused and changes nothing") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PoseGraph graph;
  CHECK(graph.optimise().converged);
  CHECK_FALSE(graph.anchor(0));
  CHECK_FALSE(graph.add_node({pose(nan, 0.0, 0.0), true, 0}));
  Eigen::Isometry3d scaled = Eigen::Isometry3d::Identity();
  scaled.linear() *= 2.0;
  CHECK_FALSE(graph.add_node({scaled, true, 0}));
  REQUIRE(graph.add_node({pose(0.0, 0.0, 0.0), true, 0}));
  REQUIRE(graph.add_node({pose(1.0, 0.0, 0.0), true, 1}));
  const Matrix6d good = diagonal_covariance(0.1, 0.1, 0.1);
  CHECK_FALSE(graph.add_edge({0, 0, pose(0.0, 0.0, 0.0), good}));
  CHECK_FALSE(graph.add_edge({0, 2, pose(0.0, 0.0, 0.0), good}));
  CHECK_FALSE(graph.add_edge({-1, 1, pose(0.0, 0.0, 0.0), good}));
  CHECK_FALSE(graph.add_edge({0, 1, pose(nan, 0.0, 0.0), good}));
  CHECK_FALSE(graph.add_edge({0, 1, pose(1.0, 0.0, 0.0), Matrix6d::Zero()}));
  CHECK_FALSE(graph.add_altitude({0, nan, 0.1}));
  CHECK_FALSE(graph.add_altitude({0, 0.0, 0.0}));
  CHECK_FALSE(graph.add_altitude({0, 0.0, 1e-300}));
  CHECK_FALSE(graph.add_altitude({0, 1e300, 0.1}));
  CHECK_FALSE(graph.add_node({pose(1e300, 0.0, 0.0), true, 0}));
  CHECK_FALSE(graph.add_edge({0, 1, pose(1.0, 0.0, 0.0), diagonal_covariance(1e-9, 0.1, 0.1)}));
  CHECK_FALSE(graph.add_stationary_ground({0, 1, -1.0}));
  CHECK_FALSE(graph.add_prior({0, pose(0.0, 0.0, 0.0), Matrix6d::Constant(nan)}));
  CHECK_FALSE(graph.relative_covariance(0, 0));
  CHECK_FALSE(graph.relative_covariance(0, 5));
  CHECK(graph.add_edge({0, 1, pose(2.0, 0.0, 0.0), good}));
  // Stamps are not measurements: whatever they are, the graph has a minimum.
  const auto last = graph.add_node({pose(2.0, 0.0, 0.0), true, std::numeric_limits<std::int64_t>::max()});
  const auto first = graph.add_node({pose(2.0, 0.0, 0.0), true, std::numeric_limits<std::int64_t>::min()});
  for (const auto& node : {last, first}) {
    CHECK(graph.add_edge({1, *node, pose(0.0, 0.0, 0.0), good}));
    CHECK(graph.add_altitude({*node, 0.0, 0.1}));
  }
  CHECK(graph.optimise().converged);
  CHECK(graph.T_map_submap(1).translation().x() == doctest::Approx(2.0));
}

}  // namespace isobar::test::test_pose_graph
