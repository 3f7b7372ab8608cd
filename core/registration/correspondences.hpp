// SPDX-License-Identifier: BSD-3-Clause
// Correspondences: the plane of the map for each sampled point of the scan. The search itself is
// MapSnapshot::match().
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
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

/// Which planes of the map count.
enum class PairChoice : std::uint8_t {
  kNearest,  ///< the nearest: for a pose that is still off
  kOwnCell,  ///< that of the point's own cell: for a pose that is right to centimetres
};

/// Finds correspondences into memory of fixed size. Not thread-safe.
class Correspondences {
 public:
  /// `capacity`: largest number of points.
  explicit Correspondences(std::size_t capacity);

  /// Begins a new scan or a new map, with the local frame at `p_map_base` [m].
  void start(const MapSnapshot& map, const Eigen::Vector3d& p_map_base);

  /// Matches every `stride`-th of `p_base`, placed at `T_map_base` and seen from `p_base_lidar`, to planes
  /// whose point is within `max_distance_m`. `map` as at start(), `p_base` the same in all calls since. The
  /// result is valid until the next call.
  ///
  /// kOwnCell leaves out extrapolated planes, those of a neighbouring cell. Where a surface ends, points of the next
  /// one (the foot of a wall, clutter on the floor) lie on one side of them only, and pull the pose there: a standing
  /// lidar settled 5 to 37 mm off. Where too few points have a plane of their own, extrapolated ones count as well.
  std::span<const Pair> find(const MapSnapshot& map, std::span<const Eigen::Vector3f> p_base,
                             std::size_t stride, const Eigen::Isometry3d& T_map_base,
                             const Eigen::Vector3d& p_base_lidar, double max_distance_m,
                             PairChoice choice = PairChoice::kNearest);
  /// Number of points of the last find() that have any plane within the distance.
  [[nodiscard]] std::size_t matched() const { return matched_; }

 private:
  void collect_pairs(std::size_t count, PairChoice choice);
  /// Rearranges matches_ for a new stride with `count` points: points of both strides keep their last match
  /// as a starting guess (from stride 6 to stride 2: every third point has one).
  void keep_matches_of_common_points(std::size_t stride, std::size_t count);

  LocalFrame frame_;
  std::size_t matched_ = 0;
  std::size_t stride_ = 0;                // of the last find(); 0 after start()
  std::vector<Eigen::Vector3f> p_robot_;  // sizes fixed in the constructor
  std::vector<Eigen::Vector3f> p_local_;
  std::vector<PlaneMatch> matches_;
  std::vector<Pair> pairs_;
};

}  // namespace isobar
