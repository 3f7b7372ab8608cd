// SPDX-License-Identifier: BSD-3-Clause
// Ground that the robot has mapped, in coarse cells, with the error that the map had there at the first visit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/registration/growing_error.hpp"

namespace isobar {

/// Error of the map at a place.
struct MapError {
  GrowingError pose;
  double height_variance_m2 = 0.0;  ///< of the method that owns a height
};

/// Memory of fixed size: the oldest ground is forgotten. Allocates in its constructor and when copied to a new object.
class VisitedGround {
 public:
  using Cell = Eigen::Vector3i;
  static constexpr double kCellM = 4.0;    ///< edge in x and y: a place has one error
  static constexpr double kStoreyM = 2.0;  ///< edge in z: floors are apart
  static constexpr std::size_t kCells = 2048;

  VisitedGround() : cells_(kCells) {}

  [[nodiscard]] static Cell cell_of(const Eigen::Vector3d& p_map);
  void clear() { count_ = 0; }
  /// `cell` is not known yet; the robot is there after `way_m`.
  void add(const Cell& cell, const MapError& error, double way_m);
  /// Error at the first visit of `cell`; where it is not known, of the neighbour that was visited first, if that was before
  /// `way_m`: from next door a lidar has seen the cell.
  [[nodiscard]] std::optional<MapError> find(const Cell& cell, double way_m) const;

 private:
  struct Visit {
    Cell cell = Cell::Zero();
    Eigen::Matrix<float, 6, 6> random;
    Eigen::Matrix<float, 6, GrowingError::kConstants> constants;
    float height_variance_m2 = 0.0F;
    double way_m = 0.0;
  };
  std::vector<Visit> cells_;  // ring
  std::size_t count_ = 0;     // visits so far
};

}  // namespace isobar
