// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/line_chart.hpp"
#include "tools/report/png.hpp"
#include "tools/report/scale.hpp"

namespace isobar::report {

/// A point of the map projected into the view [m].
struct MapPoint {
  float u = 0.0F;  ///< to the right
  float v = 0.0F;  ///< up
};

/// Density of the points: shades of grey on a transparent ground. The shade grows with the logarithm of the
/// points in a pixel, up to the 98th percentile of the pixels that are not empty.
IndexedImage density_image(const std::vector<MapPoint>& points, const Range& u, const Range& v,
                           std::size_t width, std::size_t height);

/// A labelled line across the view at height v [m].
struct LevelMark {
  double v = 0.0;
  std::string label;
};

/// A projection of the map with trajectories drawn over it, to scale.
struct MapView {
  std::string u_label;
  std::string v_label;
  std::vector<MapPoint> points;
  std::vector<Series> paths;  ///< x and y are u and v [m]
  std::vector<LevelMark> levels;
  Range u;
  Range v;
  double v_exaggeration = 1.0;  ///< scale of v over scale of u
  double width = 1040.0;
  double max_height = 700.0;  ///< [px]; limits the scale
  std::string id;             ///< unique in the page
};

Picture draw(const MapView& view);

}  // namespace isobar::report
