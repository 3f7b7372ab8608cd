// SPDX-License-Identifier: BSD-3-Clause
// Ground of one floor, as far as it can be driven: a height in each column in plan.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/floors/floor.hpp"
#include "core/floors/ground_columns.hpp"
#include "core/floors/ground_growth.hpp"

namespace isobar {

/// Ground that is connected with the path (without one on this floor: with the floor's height) without steps and steep
/// slopes. Ramps belong to it as far as the floor's slab reaches; a staircase only where it was driven.
class FloorGround {
 public:
  enum class Kind : std::uint8_t {
    kUnknown,
    kGround,  ///< of this floor
    kBeyond,  ///< leads to another floor
    kDrop,    ///< only a lower surface: an edge, or stairs that lead down
  };

  /// @param path positions of base_link in order of time [m]
  /// @throws DataError when the floor is larger than 2 km x 2 km or its like
  FloorGround(const GroundColumns& columns, const Floors& floors, const Floor& floor,
              std::span<const Eigen::Vector3d> path);

  [[nodiscard]] Kind kind(const ColumnIndex& column) const;
  /// Height of the ground in a column, or of the nearest ground up to 3 m around it [m]. False if there is none, or if
  /// the nearest one is kBeyond.
  [[nodiscard]] bool height_near(const ColumnIndex& column, float& height_m) const;
  /// True for a column that the robot drove over.
  [[nodiscard]] bool is_driven(const ColumnIndex& column) const;

  /// Columns that may have a height: `low` inclusive, `high` exclusive; empty without ground.
  [[nodiscard]] const ColumnIndex& low() const { return low_; }
  [[nodiscard]] const ColumnIndex& high() const { return high_; }
  /// Positions of the path on this floor [m].
  [[nodiscard]] const std::vector<Eigen::Vector3d>& path() const { return path_; }

 private:
  struct Column {
    float height_m = 0.0F;
    Kind kind = Kind::kUnknown;
    Kind nearest = Kind::kUnknown;  ///< of the column whose height it has
    bool driven = false;
  };
  [[nodiscard]] Column* find(const ColumnIndex& column);
  [[nodiscard]] const Column* find(const ColumnIndex& column) const;
  void place(const std::vector<GroundGrowth::Reached>& reached);
  void mark_drops(const GroundColumns& columns);
  void fill();
  void mark_driven();

  Floors::Slab slab_;
  ColumnIndex low_;
  ColumnIndex high_;
  std::vector<Column> columns_;  // rows along x
  std::vector<Eigen::Vector3d> path_;
};

}  // namespace isobar
