// SPDX-License-Identifier: BSD-3-Clause
// The plan of a city: streets along x and y, blocks between them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"

namespace isobar::simulation {

/// A street from one end of the city to the other.
struct Street {
  double axis_m = 0.0;        ///< where its middle lies, across it
  double carriage_m = 3.4;    ///< middle to kerb
  double pavement_m = 3.0;    ///< kerb to building line
  bool parking = false;       ///< cars stand along both kerbs
  double tree_every_m = 0.0;  ///< along both kerbs, 0 for none
};

/// Crossing of column `x` with row `y`, or the block that has this crossing at its lower corner.
struct Crossing {
  int x = 0;
  int y = 0;
  friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// Columns run along y, rows along x.
class CityGrid {
 public:
  static constexpr double kLaneM = 1.6;  ///< middle of the street to middle of the lane, traffic on the right

  CityGrid(Random random, int columns, int rows);

  [[nodiscard]] int columns() const { return static_cast<int>(columns_.size()); }
  [[nodiscard]] int rows() const { return static_cast<int>(rows_.size()); }
  [[nodiscard]] const Street& column(int index) const { return columns_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const Street& row(int index) const { return rows_[static_cast<std::size_t>(index)]; }
  /// Where the axes meet.
  [[nodiscard]] Eigen::Vector2d at(const Crossing& crossing) const {
    return {column(crossing.x).axis_m, row(crossing.y).axis_m};
  }
  /// The street that joins two neighbours.
  [[nodiscard]] const Street& between(const Crossing& a, const Crossing& b) const {
    return a.x == b.x ? column(a.x) : row(a.y);
  }
  /// Block and its half of the streets around it: from axis to axis.
  [[nodiscard]] Rect cell(const Crossing& block) const;
  /// Block with its pavements: from kerb to kerb.
  [[nodiscard]] Rect island(const Crossing& block) const;

 private:
  std::vector<Street> columns_;
  std::vector<Street> rows_;
};

}  // namespace isobar::simulation
