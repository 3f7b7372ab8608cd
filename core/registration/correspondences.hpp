// SPDX-License-Identifier: BSD-3-Clause
// Which plane of the map each sampled point of the scan belongs to. How it is found is the map's matcher's
// choice.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "core/map/map_snapshot.hpp"

namespace isobar {

/// A point of the scan and its plane of the map.
struct Pair {
  Eigen::Vector3f p_robot;  ///< from the robot's position to the point, axes of the map [m]
  Eigen::Vector3f normal;   ///< of the plane, axes of the map, unit
  float residual_m;         ///< n^T (p - q), from the plane to the point
};

/// Finds pairs into memory of fixed size.
class Correspondences {
 public:
  /// `capacity`: points at most.
  explicit Correspondences(std::size_t capacity);

  /// Begins with a new scan or a new map near `p_map_base`.
  void start(const MapSnapshot& map, const Eigen::Vector3d& p_map_base);

  /// Matches every `stride`-th of `p_base` placed at `T_map_base`, seen from `p_base_lidar`, to planes whose
  /// point is within `max_distance_m`. `map` and `p_base` as at start(). The result is valid until the next
  /// call.
  std::span<const Pair> find(const MapSnapshot& map, std::span<const Eigen::Vector3f> p_base,
                             std::size_t stride, const Eigen::Isometry3d& T_map_base,
                             const Eigen::Vector3d& p_base_lidar, double max_distance_m);

 private:
  /// Makes matches_ those of every `stride`-th point, `count` of them: where the ones before were every
  /// sixth, say, and these are every second, each third has its match already.
  void keep_matches_of_common_points(std::size_t stride, std::size_t count);

  LocalFrame frame_;
  std::size_t stride_ = 0;                // of the last find(); 0 after start()
  std::vector<Eigen::Vector3f> p_robot_;  // sizes are fixed in the constructor
  std::vector<Eigen::Vector3f> p_local_;
  std::vector<PlaneMatch> matches_;
  std::vector<Pair> pairs_;
};

}  // namespace isobar
