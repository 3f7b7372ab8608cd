// SPDX-License-Identifier: BSD-3-Clause
// A drive through a building as a pose graph, with the truth: laps of a corridor on four stacked floors, an elevator
// between them, odometry, altitudes with the air's bias, loops that are right and loops that are not.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

#include "core/graph/pose_graph.hpp"

namespace isobar::test {

/// Size and noise of the drive.
struct BuildingOptions {
  int nodes = 1000;
  int right_loops = 20;
  int wrong_loops = 0;
  bool noise = true;
  bool altitude = true;
  bool held_by_gravity = true;
  unsigned seed = 1;
};

/// Standard deviations that the simulated measurements have.
struct BuildingNoise {
  double odometry_m = 0.01;      ///< x and y of an edge of 2 m
  double odometry_z_m = 0.005;   ///< z
  double odometry_rad = 3.5e-4;  ///< 0.02°
  double loop_m = 0.02;          ///< each axis
  double loop_rad = 1.7e-3;      ///< 0.1°
  double altitude_m = 0.05;      ///< white noise of an altitude
};

/// The drive: what a graph is fed with, and the truth.
struct Building {
  std::vector<Eigen::Isometry3d> T_map_submap;  ///< truth
  std::vector<std::int64_t> stamp_ns;
  std::vector<RelativePoseEdge> odometry;
  std::vector<RelativePoseEdge> loops;  ///< in random order of right and wrong
  std::vector<bool> loop_right;
  std::vector<double> bias_m;  ///< truth
  std::vector<AltitudeFactor> altitudes;
  bool held_by_gravity = true;
};

inline constexpr double kFloorHeightM = 3.2;

/// A drive with these options.
Building make_building(const BuildingOptions& options, const BuildingNoise& noise = {});

/// Adds nodes `begin` … `end` - 1, at the poses that odometry predicts from the node before, with their odometry and
/// altitudes.
void add_drive(const Building& building, int begin, int end, PoseGraph& graph);

/// Adds the loops between nodes that the graph has, and that lead to nodes `begin` … `end` - 1.
/// @return their numbers in Building::loops
std::vector<int> add_loops(const Building& building, int begin, int end, bool right, bool wrong,
                           PoseGraph& graph);

/// Covariance of an edge with these standard deviations.
Matrix6d diagonal_covariance(double xy_m, double z_m, double rad);

/// Largest distance between the positions of two graphs [m].
double largest_distance_m(const PoseGraph& a, const PoseGraph& b);

/// Root mean square of the distances from the truth [m].
double rms_error_m(const PoseGraph& graph, const Building& building);

}  // namespace isobar::test
