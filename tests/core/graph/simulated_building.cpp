// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/graph/simulated_building.hpp"

#include <algorithm>
#include <cmath>

#include "core/so3.hpp"

namespace isobar::test {

namespace {

constexpr int kNodesPerLap = 90;  // corridor of 60 m x 30 m, a node every 2 m
constexpr int kLapsPerFloor = 3;
constexpr int kFloors = 4;
constexpr double kStepM = 2.0;
constexpr double kStepS = 2.0;

// Up and down again: 0 1 2 3 2 1 0 1 …
int floor_of(int node) {
  const int visit = node / (kNodesPerLap * kLapsPerFloor) % (2 * kFloors - 2);
  return visit < kFloors ? visit : 2 * kFloors - 2 - visit;
}

Eigen::Isometry3d pose_on_way(int node) {
  const double way_m = kStepM * (node % kNodesPerLap);
  const double sides_m[] = {60.0, 30.0, 60.0, 30.0};
  const Eigen::Vector2d corners[] = {{0.0, 0.0}, {60.0, 0.0}, {60.0, 30.0}, {0.0, 30.0}};
  double left_m = way_m;
  int side = 0;
  while (left_m >= sides_m[side]) left_m -= sides_m[side++];
  const double yaw = 0.5 * M_PI * side;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_about_z(yaw);
  T.translation() << corners[side] + left_m * Eigen::Vector2d(std::cos(yaw), std::sin(yaw)),
      kFloorHeightM * floor_of(node);
  return T;
}

class Maker {
 public:
  Maker(const BuildingOptions& options, const BuildingNoise& noise)
      : options_(options), noise_(noise), random_(options.seed) {}

  Building make() {
    out_.held_by_gravity = options_.held_by_gravity;
    for (int n = 0; n < options_.nodes; ++n) add_node(n);
    std::vector<bool> kinds(static_cast<std::size_t>(options_.right_loops), true);
    kinds.resize(kinds.size() + static_cast<std::size_t>(options_.wrong_loops), false);
    std::shuffle(kinds.begin(), kinds.end(), random_);
    for (const bool right : kinds) add_loop(right);
    return out_;
  }

 private:
  double normal(double sigma) { return options_.noise ? sigma * normal_(random_) : (normal_(random_), 0.0); }
  int integer(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

  // A robot on a floor that is not level: 0.6° of roll and pitch.
  void add_node(int n) {
    Eigen::Isometry3d T = pose_on_way(n);
    T.rotate(rotation_from_rpy({0.01 * normal_(random_), 0.01 * normal_(random_), 0.0}));
    out_.T_map_submap.push_back(T);
    out_.stamp_ns.push_back(static_cast<std::int64_t>(1e9 * kStepS * n));
    const AltimeterBias bias;
    const double phi = std::exp(-kStepS / bias.time_s);
    const double before_m = n == 0 ? 0.0 : out_.bias_m.back();
    out_.bias_m.push_back(n == 0 ? 0.0 : phi * before_m + normal(bias.sigma_m * std::sqrt(1.0 - phi * phi)));
    out_.altitudes.push_back(
        {n, T.translation().z() + out_.bias_m.back() + normal(noise_.altitude_m), noise_.altitude_m});
    if (!options_.altitude) out_.altitudes.clear();
    if (n > 0)
      out_.odometry.push_back(
          measured(n - 1, n, noise_.odometry_m, noise_.odometry_z_m, noise_.odometry_rad));
  }

  RelativePoseEdge measured(int from, int to, double xy_m, double z_m, double rad) {
    RelativePoseEdge edge{from, to, truth(from).inverse() * truth(to), diagonal_covariance(xy_m, z_m, rad)};
    edge.T_from_to.translation() += Eigen::Vector3d(normal(xy_m), normal(xy_m), normal(z_m));
    const Eigen::Vector3d turn(normal(rad), normal(rad), normal(rad));
    edge.T_from_to.linear() = (exp_so3(turn) * edge.T_from_to.linear()).eval();
    return edge;
  }

  [[nodiscard]] const Eigen::Isometry3d& truth(int n) const {
    return out_.T_map_submap[static_cast<std::size_t>(n)];
  }

  // The same place on an earlier lap, of the same floor; a wrong one of another floor, or 20 m off.
  void add_loop(bool right) {
    const bool other_floor = !right && integer(2) == 0;
    for (;;) {
      const int to = integer(options_.nodes);
      const int laps = to / kNodesPerLap;
      if (laps == 0) continue;
      const int from = to - kNodesPerLap * (1 + integer(laps));
      if ((floor_of(from) == floor_of(to)) == other_floor) continue;
      RelativePoseEdge loop = measured(from, to, noise_.loop_m, noise_.loop_m, noise_.loop_rad);
      loop.kind = EdgeKind::kLoop;
      if (other_floor)
        loop.T_from_to.translation().z() += truth(from).translation().z() - truth(to).translation().z();
      if (!right && !other_floor) loop.T_from_to.translation().x() += 20.0;
      out_.loops.push_back(loop);
      out_.loop_right.push_back(right);
      return;
    }
  }

  BuildingOptions options_;
  BuildingNoise noise_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  Building out_;
};

}  // namespace

Building make_building(const BuildingOptions& options, const BuildingNoise& noise) {
  return Maker(options, noise).make();
}

Matrix6d diagonal_covariance(double xy_m, double z_m, double rad) {
  Vector6d sigma;
  sigma << xy_m, xy_m, z_m, rad, rad, rad;
  return sigma.cwiseAbs2().asDiagonal();
}

void add_drive(const Building& building, int begin, int end, PoseGraph& graph) {
  for (int n = begin; n < end; ++n) {
    const auto at = static_cast<std::size_t>(n);
    GraphNode node{building.T_map_submap[at], building.held_by_gravity, building.stamp_ns[at]};
    if (n > 0) {
      const Eigen::Isometry3d T = graph.T_map_submap(n - 1) * building.odometry[at - 1].T_from_to;
      node.T_map_submap.translation() = T.translation();
      // Roll and pitch from gravity, that is from the truth, where it holds them.
      const double turn_rad = yaw_of(Eigen::Quaterniond(T.linear())) -
                              yaw_of(Eigen::Quaterniond(building.T_map_submap[at].linear()));
      node.T_map_submap.linear() =
          building.held_by_gravity
              ? Eigen::Matrix3d(rotation_about_z(turn_rad) * building.T_map_submap[at].linear())
              : Eigen::Matrix3d(Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix());
    }
    bool added = graph.add_node(node).has_value();
    if (n > 0) added = added && graph.add_edge(building.odometry[at - 1]);
    if (!building.altitudes.empty()) added = added && graph.add_altitude(building.altitudes[at]);
    if (!added) return;
  }
}

std::vector<int> add_loops(const Building& building, int begin, int end, bool right, bool wrong,
                           PoseGraph& graph) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < building.loops.size(); ++i) {
    const RelativePoseEdge& loop = building.loops[i];
    const bool wanted = building.loop_right[i] ? right : wrong;
    if (wanted && loop.to >= begin && loop.to < end && graph.add_edge(loop))
      numbers.push_back(static_cast<int>(i));
  }
  return numbers;
}

double largest_distance_m(const PoseGraph& a, const PoseGraph& b) {
  double largest_m = 0.0;
  for (std::size_t n = 0; n < a.nodes().size(); ++n) {
    const Eigen::Vector3d gap =
        a.nodes()[n].T_map_submap.translation() - b.nodes()[n].T_map_submap.translation();
    largest_m = std::max(largest_m, gap.norm());
  }
  return largest_m;
}

double rms_error_m(const PoseGraph& graph, const Building& building) {
  double sum_m2 = 0.0;
  for (std::size_t n = 0; n < graph.nodes().size(); ++n) {
    sum_m2 +=
        (graph.nodes()[n].T_map_submap.translation() - building.T_map_submap[n].translation()).squaredNorm();
  }
  return std::sqrt(sum_m2 / static_cast<double>(graph.nodes().size()));
}

}  // namespace isobar::test
