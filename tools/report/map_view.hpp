// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/line_chart.hpp"
#include "tools/report/png.hpp"
#include "tools/report/scale.hpp"

namespace isobar::report {

/// A point of the map seen from one side [m].
struct MapPoint {
  float u = 0.0F;  ///< to the right
  float v = 0.0F;  ///< up
};

/// How many points fall on each pixel, as shades of grey on a transparent ground; the shade grows with the
/// logarithm of the number up to the 98th percentile of the pixels that have any.
IndexedImage density_image(const std::vector<MapPoint>& points, const Range& u, const Range& v,
                           std::size_t width, std::size_t height);

/// Mean height of a floor in the reference, drawn across the view.
struct LevelMark {
  double v = 0.0;
  std::string label;
};

/// The map from one side with trajectories over it, to scale.
struct MapView {
  std::string u_label;
  std::string v_label;
  std::vector<MapPoint> points;
  std::vector<Series> paths;  ///< x and y are u and v [m]
  std::vector<LevelMark> levels;
  Range u;
  Range v;
  double v_exaggeration = 1.0;  ///< pixels a metre in v over those in u
  double width = 1040.0;
  double max_height = 700.0;  ///< the view is made narrower where it would be higher
  bool legend = true;
  std::string id;  ///< unique in the page
};

Picture draw(const MapView& view);

}  // namespace isobar::report
