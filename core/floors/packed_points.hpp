// SPDX-License-Identifier: BSD-3-Clause
// Points of a tile in a third of their memory, for a map that is kept whole.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/map/map_point.hpp"

namespace isobar {

/// Points in fixed point around their middle: 12 bytes each. Positions are kept to 1/65000 of the extent of the points (a
/// tenth of a millimetre for a tile), normals to 0.01; intensities are not kept.
class PackedPoints {
 public:
  PackedPoints() = default;
  /// Points that are not finite, or 1e7 m or more from the origin, are left out.
  explicit PackedPoints(std::span<const MapPoint> points);

  /// Replaces `points` by these points.
  void unpack(std::vector<MapPoint>& points) const;
  [[nodiscard]] std::size_t size() const { return points_.size(); }

 private:
  struct Point {
    std::array<std::int16_t, 3> p{};
    std::array<std::int8_t, 3> normal{};
    std::uint8_t observations = 0;
    std::uint8_t filled = 0;
  };
  static_assert(sizeof(Point) == 12);

  Eigen::Vector3d middle_m_ = Eigen::Vector3d::Zero();
  double unit_m_ = 0.0;
  std::vector<Point> points_;
};

}  // namespace isobar
