// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/report/scale.hpp"

namespace isobar::report {

/// A line through points; a value that is not finite interrupts it.
struct Series {
  std::string name;
  Stroke stroke;
  std::vector<double> x;
  std::vector<double> y;
  bool on_top = false;  ///< drawn after the others
};

/// The area between two lines, below all lines.
struct Ribbon {
  std::string colour;
  std::vector<double> x;
  std::vector<double> low;
  std::vector<double> high;
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
  std::vector<Ribbon> ribbons;
  std::vector<Band> bands;
  std::optional<Range> x_range;  ///< default: the data's
  std::optional<Range> y_range;  ///< default: the data's; lines are clipped to it
  double min_y_width = 0.1;      ///< smallest width of a default y range
  bool zero_line = false;        ///< a line at y = 0
  bool is_logarithmic = false;   ///< both axes; all data > 0
  double width = 1040.0;
  double height = 340.0;
  std::string id;  ///< unique in the page
};

Picture draw(const LineChart& chart);

/// Legend entries of the lines that have a name.
std::vector<LegendEntry> legend_of(const std::vector<Series>& lines);

/// At most four points per pixel column (first, lowest, highest, last): same look, smaller file.
std::vector<Point> thinned(const std::vector<Point>& points);

/// Drops points within `tolerance_px` of the line through the remaining ones (Douglas and Peucker 1973).
std::vector<Point> simplified(const std::vector<Point>& points, double tolerance_px);

}  // namespace isobar::report
