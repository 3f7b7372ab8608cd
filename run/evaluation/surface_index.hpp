// SPDX-License-Identifier: BSD-3-Clause
// Distance of points from known surfaces.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "run/files/stl_file.hpp"

namespace isobar::evaluation {

/// Triangles by cells of space. Immutable.
class SurfaceIndex {
 public:
  /// Distances beyond this are not told apart [m].
  static constexpr float kReachM = 0.25F;
  /// More triangles than this take gigabytes and minutes.
  static constexpr std::size_t kMaxTriangles = 1'500'000;

  explicit SurfaceIndex(std::vector<files::SurfaceTriangle> triangles);

  /// Distance from the nearest triangle; kReachM where none is nearer.
  [[nodiscard]] float distance_m(const Eigen::Vector3f& point) const;

 private:
  struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };

  std::vector<files::SurfaceTriangle> triangles_;
  std::vector<std::uint32_t> by_cell_;  ///< triangles of all cells, one cell after another
  std::unordered_map<std::uint64_t, Range> cells_;
};

/// Where the points of a map lie; NaN: no map, or no known surfaces.
struct MapFigures {
  double within_5_cm = std::numeric_limits<double>::quiet_NaN();   ///< share of points, 0 … 1
  double beyond_20_cm = std::numeric_limits<double>::quiet_NaN();  ///< share of points, 0 … 1
};

/// @param points in the frame of the surfaces
MapFigures map_figures(const std::vector<std::array<float, 3>>& points, const SurfaceIndex& surfaces);

}  // namespace isobar::evaluation
