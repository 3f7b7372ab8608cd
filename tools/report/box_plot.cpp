// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/box_plot.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::report {

namespace {

constexpr double kRowHeight = 46.0;
constexpr double kBoxHeight = 24.0;
constexpr double kBoxTopMargin = 26.0;
constexpr double kBoxBottomMargin = 50.0;
constexpr double kLogarithmicFrom = 25.0;

bool is_drawn(const BoxPlot::Row& row) { return row.values.count > 0 && std::isfinite(row.values.median); }

Scale scale_of(const BoxPlot& plot, double px_low, double px_high) {
  double largest = 0.0;
  double smallest_median = INFINITY;
  double smallest_quartile = INFINITY;
  for (const BoxPlot::Row& row : plot.rows) {
    if (!is_drawn(row)) continue;
    largest = std::max(largest, row.values.p95);
    if (row.values.median > 0.0) smallest_median = std::min(smallest_median, row.values.median);
    if (row.values.q25 > 0.0) smallest_quartile = std::min(smallest_quartile, row.values.q25);
  }
  const bool is_log = std::isfinite(smallest_quartile) && largest > kLogarithmicFrom * smallest_median;
  if (is_log) {
    // Whiskers may reach down to nothing; the axis ends a little below the smallest box, at most five decades
    // down.
    return Scale::logarithmic({std::max(0.4 * smallest_quartile, 1e-5 * largest), 1.3 * largest}, px_low,
                              px_high);
  }
  return Scale::linear({0.0, largest > 0.0 ? 1.06 * largest : 1.0}, px_low, px_high, 90.0);
}

void draw_row(Picture& picture, const BoxPlot::Row& row, const Axes& axes, double y) {
  const Scale& x = axes.x;
  const Distribution& d = row.values;
  const Stroke stroke{row.colour, 1.6};
  picture.line({x.clamped(d.p05), y}, {x.clamped(d.q25), y}, stroke);
  picture.line({x.clamped(d.q75), y}, {x.clamped(d.p95), y}, stroke);
  const bool cut = d.p05 < x.range().low;  // no cap where a whisker leaves a logarithmic axis
  if (!cut) picture.line({x(d.p05), y - 7.0}, {x(d.p05), y + 7.0}, stroke);
  picture.line({x.clamped(d.p95), y - 7.0}, {x.clamped(d.p95), y + 7.0}, stroke);
  const Box box{x.clamped(d.q25), y - 0.5 * kBoxHeight, x.clamped(d.q75) - x.clamped(d.q25), kBoxHeight};
  picture.rect(box, "#ffffff");
  picture.rect(box, row.colour, 0.28);
  picture.outline(box, stroke);
  picture.line({x.clamped(d.median), box.y}, {x.clamped(d.median), box.bottom()}, {row.colour, 3.2});
}

}  // namespace

Picture draw(const BoxPlot& plot) {
  double left = 60.0;
  for (const BoxPlot::Row& row : plot.rows) left = std::max(left, text_width(row.name, 14.0) + 18.0);
  constexpr double kBoxRightMargin = 96.0;
  Picture picture(plot.width,
                  kBoxTopMargin + kRowHeight * static_cast<double>(plot.rows.size()) + kBoxBottomMargin);
  const Box frame{left, kBoxTopMargin, plot.width - left - kBoxRightMargin,
                  kRowHeight * static_cast<double>(plot.rows.size())};
  const Axes axes{frame,
                  scale_of(plot, frame.x, frame.right()),
                  Scale::linear({0.0, 1.0}, frame.bottom(), frame.y, frame.height),
                  plot.x_label,
                  "",
                  false,
                  false};
  draw_axes(picture, axes);
  picture.text({frame.right() + 10.0, kBoxTopMargin - 10.0}, "median", {12.0, "#4b5563"});
  double y = kBoxTopMargin + 0.5 * kRowHeight;
  for (const BoxPlot::Row& row : plot.rows) {
    picture.text({left - 10.0, y + 5.0}, row.name, {14.0, "#1f2937", "end"});
    const std::string median =
        is_drawn(row) ? fixed(row.values.median, plot.decimals) + " " + plot.unit : "no data";
    picture.text({frame.right() + 10.0, y + 5.0}, median, {14.0, "#1f2937", "start", true});
    if (is_drawn(row)) draw_row(picture, row, axes, y);
    y += kRowHeight;
  }
  return picture;
}

}  // namespace isobar::report
