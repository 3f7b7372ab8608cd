// SPDX-License-Identifier: BSD-3-Clause
// Section of the surfaces of a simulated recording: the walls that a grid of a floor should show.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "run/files/stl_file.hpp"

namespace isobar::bench {

/// Surfaces by squares of 5 cm in plan, each with the heights at which it is crossed.
class TrueSection {
 public:
  static constexpr double kSquareM = 0.05;

  explicit TrueSection(const std::vector<files::SurfaceTriangle>& triangles);

  using Square = Eigen::Vector2i;
  [[nodiscard]] static Square square_of(const Eigen::Vector2d& p) {
    return (p / kSquareM).array().floor().cast<int>();
  }
  /// True if a surface crosses the square between two heights.
  [[nodiscard]] bool is_wall(const Square& square, double low_m, double high_m) const;
  /// The same for the square and the ones within `reach` of it.
  [[nodiscard]] bool is_near_wall(const Square& square, double low_m, double high_m, int reach) const;

 private:
  void add(const files::SurfaceTriangle& triangle);
  void add(const Eigen::Vector3d& p);

  static constexpr double kLayerM = 0.05;
  std::unordered_map<std::uint64_t, std::vector<std::int16_t>> layers_;  // crossed, by square
};

}  // namespace isobar::bench
