// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/report/scale.hpp"

namespace isobar::report {

/// A line through points of ascending x. A NaN interrupts it.
struct Series {
  std::string name;
  Stroke stroke;
  std::vector<double> x;
  std::vector<double> y;
  bool on_top = false;  ///< drawn after the others
};

/// A labelled span of x.
struct Band {
  double from = 0.0;
  double to = 0.0;
  std::string label;
  bool shaded = true;
};

struct LineChart {
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::vector<Band> bands;
  std::optional<Range> x_range;  ///< else all of the data
  std::optional<Range> y_range;  ///< else all of the data; lines are cut at it
  double min_y_width = 0.1;      ///< of a range taken from the data
  bool zero_line = false;
  bool is_logarithmic = false;  ///< both axes; all data are > 0
  double width = 1040.0;
  double height = 340.0;
  std::string id;  ///< unique in the page
};

Picture draw(const LineChart& chart);

/// At most four points for each pixel column (first, lowest, highest, last): looks the same, and is small.
std::vector<Point> thinned(const std::vector<Point>& points);

/// Without the points that lie within `tolerance_px` of the line through those that stay (Douglas and Peucker
/// 1973).
std::vector<Point> simplified(const std::vector<Point>& points, double tolerance_px);

}  // namespace isobar::report
