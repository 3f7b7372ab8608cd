// SPDX-License-Identifier: BSD-3-Clause
// Horizontal surfaces of the map that face upwards, by columns in plan.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/map/map_point.hpp"

namespace isobar {

/// Index of a column in plan: floor(p_map / kColumnM).
struct ColumnIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const ColumnIndex&) const =
      default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 is wrong here
};

/// Ground, steps, tables: every surface that something could stand on.
class GroundColumns {
 public:
  static constexpr double kColumnM = 0.25;     ///< edge of a column
  static constexpr float kLeastUpward = 0.8F;  ///< z of the normals, 37 degrees

  static constexpr std::uint32_t kLeastPoints =
      2;  ///< of a surface that counts as ground: single ones are noise

  struct Surface {
    ColumnIndex column;
    float height_m = 0.0F;    ///< mean of its points
    std::uint32_t count = 0;  ///< points
  };

  /// True for a point of the map that lies on such a surface.
  [[nodiscard]] static bool is_upward(const MapPoint& point) { return point.normal_map.z() >= kLeastUpward; }
  [[nodiscard]] static ColumnIndex column_of(const Eigen::Vector3d& p_map);

  /// Takes the upward points; points that are not finite or beyond 1e8 m are left out. Memory: 32 bytes a surface and
  /// a bounded buffer.
  void add(std::span<const MapPoint> points);
  /// After the last add(), before the first reading. Removes surfaces that lie close below a larger one of their column,
  /// such as the underside of a thin deck: nothing can stand there.
  void finish();

  /// Surfaces of a column, from the lowest to the highest.
  [[nodiscard]] std::span<const Surface> at(const ColumnIndex& column) const;
  /// Sorted by column and height.
  [[nodiscard]] const std::vector<Surface>& surfaces() const { return surfaces_; }

 private:
  void compress();

  std::vector<Surface> surfaces_;
  std::vector<Surface> pending_;  // one point each
};

}  // namespace isobar
