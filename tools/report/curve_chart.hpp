// SPDX-License-Identifier: BSD-3-Clause
// A chart of lines and points as data; tools/web/page/src/curve_chart.ts draws it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/report/stroke.hpp"

namespace isobar::report {

/// A line through points; a value that is not finite interrupts it.
struct Curve {
  std::string name;  ///< empty: not in the legend
  Stroke stroke;
  std::vector<double> x;    ///< finite, ascending
  std::vector<double> y;    ///< as many
  bool is_stepped = false;  ///< each value holds until the next x, with the area below it filled
};

/// The area between two lines, below all lines.
struct Area {
  std::string colour;
  std::vector<double> x;
  std::vector<double> low;
  std::vector<double> high;
};

/// Single points, below all lines. They do not widen the axes.
struct Dots {
  std::string colour;
  std::vector<double> x;
  std::vector<double> y;
};

/// A labelled, shaded span of x.
struct Span {
  double from = 0.0;
  double to = 0.0;
  std::string label;
};

struct CurveChart {
  std::string x_label;
  std::string y_label;
  std::string x_unit;
  std::string y_unit;
  int y_decimals = 2;  ///< of values under the cursor
  std::vector<Curve> curves;
  std::vector<Area> areas;
  std::vector<Dots> dots;
  std::vector<Span> spans;
  std::optional<std::array<double, 2>> x_range;  ///< default: the data's
  std::optional<std::array<double, 2>> y_range;  ///< default: the data's
  bool is_logarithmic = false;                   ///< both axes; all data > 0
};

/// The chart as JSON. Long columns keep the first, lowest, highest and last value of each of many spans of x: the same
/// look, a smaller file.
std::string chart_json(const CurveChart& chart);

/// Rows of `y` that are kept of a long column, ascending; all of a short one.
std::vector<std::size_t> rows_to_keep(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace isobar::report
