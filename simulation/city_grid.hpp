// SPDX-License-Identifier: BSD-3-Clause
// Street plan of a city: streets along x and y, blocks between them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// A street across the whole city.
struct Street {
  double axis_m = 0.0;        ///< coordinate of its axis: x of a column, y of a row
  double carriage_m = 3.4;    ///< axis to kerb
  double pavement_m = 3.0;    ///< kerb to building line
  bool parking = false;       ///< parked cars along both kerbs
  double tree_every_m = 0.0;  ///< spacing of trees along both kerbs; 0: no trees
};

/// Crossing of column `x` and row `y`; also names the block that has this crossing at its corner of lowest
/// coordinates.
struct Crossing {
  int x = 0;
  int y = 0;
  friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// Streets of a city: columns run along y, rows along x.
class CityGrid {
 public:
  static constexpr double kLaneM = 1.6;  ///< axis of the street to centre of the lane; traffic on the right

  CityGrid(Random random, int columns, int rows);

  [[nodiscard]] int columns() const { return static_cast<int>(columns_.size()); }
  [[nodiscard]] int rows() const { return static_cast<int>(rows_.size()); }
  [[nodiscard]] const Street& column(int index) const { return columns_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const Street& row(int index) const { return rows_[static_cast<std::size_t>(index)]; }
  /// Intersection of the axes of the two streets [m].
  [[nodiscard]] Eigen::Vector2d at(const Crossing& crossing) const {
    return {column(crossing.x).axis_m, row(crossing.y).axis_m};
  }
  /// Street between two adjacent crossings.
  [[nodiscard]] const Street& between(const Crossing& a, const Crossing& b) const {
    return a.x == b.x ? column(a.x) : row(a.y);
  }
  /// Block with the adjacent halves of the streets around it, from axis to axis.
  [[nodiscard]] Rect cell(const Crossing& block) const;
  /// Block with its pavements, from kerb to kerb.
  [[nodiscard]] Rect island(const Crossing& block) const;

 private:
  std::vector<Street> columns_;
  std::vector<Street> rows_;
};

}  // namespace isobar::simulation
