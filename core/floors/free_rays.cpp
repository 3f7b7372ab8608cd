// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/free_rays.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/map/grid.hpp"

namespace isobar {

namespace {

/// Cells along a ray, each that it touches (Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing",
/// 1987): a wall that is connected over corners lets none through.
class CellWalk {
 public:
  CellWalk(const Eigen::Vector2d& from, const Eigen::Vector2d& direction)
      : cell_(floor_int(from.x()), floor_int(from.y())) {
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      step_[axis] = direction[axis] < 0.0 ? -1 : 1;
      const double inverse = 1.0 / std::abs(direction[axis]);  // infinite along the other axis
      const double in_cell = from[axis] - cell_[axis];
      per_cell_[axis] = inverse;
      next_[axis] = std::isfinite(inverse) ? (step_[axis] > 0 ? 1.0 - in_cell : in_cell) * inverse
                                           : std::numeric_limits<double>::infinity();
    }
  }
  [[nodiscard]] const Eigen::Vector2i& cell() const { return cell_; }
  /// Way at which the ray enters the cell [cells].
  [[nodiscard]] double way() const { return way_; }
  void advance() {
    const Eigen::Index axis = next_.x() < next_.y() ? 0 : 1;
    way_ = next_[axis];
    cell_[axis] += step_[axis];
    next_[axis] += per_cell_[axis];
  }

 private:
  Eigen::Vector2i cell_;
  Eigen::Vector2i step_;
  Eigen::Vector2d per_cell_;
  Eigen::Vector2d next_;
  double way_ = 0.0;
};

}  // namespace

FreeRays::FreeRays(OccupancyGrid& grid, std::span<const CellGround> ground, double ray_m,
                   double most_unseen_m)
    : grid_(grid),
      ground_(ground),
      ray_cells_(ray_m / grid.resolution_m),
      most_unseen_cells_(most_unseen_m / grid.resolution_m) {}

void FreeRays::cast_from(const Eigen::Vector2d& p_map) {
  const Eigen::Vector2d from = (p_map - grid_.origin_m) / grid_.resolution_m;
  if (!grid_.contains(floor_int(from.x()), floor_int(from.y()))) return;
  // At the end of a ray, neighbouring ones are 1.5 cells apart: those of the next places close the gaps.
  const int count = static_cast<int>(std::ceil(2.0 * std::numbers::pi * ray_cells_ / 1.5));
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * (i + 0.5) / count;
    cast(from, {std::cos(angle_rad), std::sin(angle_rad)});
  }
}

void FreeRays::cast(const Eigen::Vector2d& from_cells, const Eigen::Vector2d& direction) {
  passed_.clear();
  std::size_t supported = 0;  // number of passed cells up to the last one with ground
  double supported_way = 0.0;
  bool hit = false;
  CellWalk walk(from_cells, direction);
  for (; walk.way() <= ray_cells_; walk.advance()) {
    if (!grid_.contains(walk.cell().x(), walk.cell().y())) break;
    const std::size_t at = grid_.index(walk.cell().x(), walk.cell().y());
    if (ground_[at] == CellGround::kBlocked) break;
    if (grid_.cells[at] == kCellOccupied) {
      hit = true;
      break;
    }
    passed_.push_back(at);
    if (ground_[at] == CellGround::kSeen) {
      supported = passed_.size();
      supported_way = walk.way();
    } else if (walk.way() - supported_way > most_unseen_cells_) {
      break;
    }
  }
  const std::size_t clear = hit ? passed_.size() : supported;
  for (std::size_t i = 0; i < clear; ++i) grid_.cells[passed_[i]] = kCellFree;
}

}  // namespace isobar
