// SPDX-License-Identifier: BSD-3-Clause
// Walls: planes that are nearly plumb, found as patches of a grid of cells.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/mounts/tilt_evidence.hpp"

namespace isobar {

/// Finds walls. Allocates in its constructor only. Not thread-safe.
class WallPatches {
 public:
  WallPatches();

  /// Tilt of the walls against gravity. Walls of one direction say one component; the variance of the other is large.
  /// None where there are few plumb patches, or they disagree: no building. `p_level`: points in a frame whose z axis
  /// is gravity's [m].
  std::optional<TiltEvidence> find(std::span<const LevelPoint> p_level);
  /// Removes the points on plumb patches of the last find() from `p_level`: near a floor they look like it.
  void remove_walls(std::vector<LevelPoint>& p_level) const;

 private:
  /// Sums over the points of a cell; its plane, where it holds a plumb patch.
  struct Cell {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int count = 0;
    bool plumb = false;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float offset_m = 0.0F;  ///< normal . p of its points
  };
  /// A plumb plane: cross-section of its normal with the horizontal, and its tilt along that.
  struct Patch {
    [[nodiscard]] Eigen::Vector3d row() const { return {across.x(), across.y(), lean_per_m}; }
    Eigen::Vector2d across = Eigen::Vector2d::Zero();  ///< unit vector
    double tilt_rad = 0.0;                             ///< across . (a, b)
    double lean_per_m = 0.0;                           ///< share in the lean of all walls away from the lidar
    double variance_rad2 = 0.0;
  };

  void fill(std::span<const LevelPoint> p_level, bool refine);
  void collect_patches(double flat_m);
  [[nodiscard]] Eigen::Vector3d fit_again(const Eigen::Vector3d& before, Eigen::Matrix3d& A) const;
  [[nodiscard]] static std::optional<Patch> patch_of(Cell& cell, double flat_m);
  [[nodiscard]] static bool on_wall(const Cell& cell, const Eigen::Vector3f& p);
  [[nodiscard]] double agreeing_share(const Eigen::Vector3d& fit) const;

  std::vector<Cell> cells_;
  std::vector<Patch> patches_;
};

}  // namespace isobar
