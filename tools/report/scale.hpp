// SPDX-License-Identifier: BSD-3-Clause
// From values to pixels, with round ticks.
#pragma once

#include <string>
#include <vector>

#include "tools/report/svg.hpp"

namespace isobar::report {

struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// The smallest range that holds all finite values; 0 … 1 without any.
Range range_of(const std::vector<double>& values);
Range united(const Range& a, const Range& b);
/// Widened to `min_width`, then by `share` of its width at both ends.
Range padded(const Range& range, double share, double min_width = 1e-9);

struct Tick {
  double value = 0.0;
  std::string label;
};

class Scale {
 public:
  /// About one tick per `tick_px`. The ranges of a logarithmic scale are > 0.
  static Scale linear(const Range& values, double px_low, double px_high, double tick_px);
  static Scale logarithmic(const Range& values, double px_low, double px_high);

  /// The pixel of a value; extrapolates outside the range.
  [[nodiscard]] double operator()(double value) const;
  /// The pixel of the nearest value inside the range.
  [[nodiscard]] double clamped(double value) const;
  [[nodiscard]] const std::vector<Tick>& ticks() const { return ticks_; }
  [[nodiscard]] const Range& range() const { return range_; }

 private:
  Scale(const Range& values, double px_low, double px_high, bool is_log);

  Range range_;
  double px_low_;
  double px_high_;
  bool is_log_;
  std::vector<Tick> ticks_;
};

/// Frame, grid, ticks and labels of a plot whose inner area is `frame`.
struct Axes {
  Box frame;
  Scale x;
  Scale y;
  std::string x_label;
  std::string y_label;
  bool y_ticks = true;
  bool y_grid = true;
};
void draw_axes(Picture& picture, const Axes& axes);

/// A line's name and look.
struct LegendEntry {
  std::string name;
  Stroke stroke;
};
/// Draws a legend from the left, in as many rows as `width` needs; returns its height (0 without entries).
double draw_legend(Picture& picture, Point at, double width, const std::vector<LegendEntry>& entries);
double legend_height(double width, const std::vector<LegendEntry>& entries);

/// Room around the frame of a chart for ticks and labels of both axes [px].
inline constexpr double kLeftMarginPx = 68.0;
inline constexpr double kRightMarginPx = 14.0;
inline constexpr double kBottomMarginPx = 50.0;

// Distance of the ticks of a linear axis [px]: labels stand beside each other on x, below each other on y.
inline constexpr double kXTickPx = 90.0;
inline constexpr double kYTickPx = 44.0;

/// Draws the legend at the top of the picture and returns the frame between the margins below it, `gap_px`
/// below the legend.
Box frame_below_legend(Picture& picture, const std::vector<LegendEntry>& entries, double gap_px);

}  // namespace isobar::report
