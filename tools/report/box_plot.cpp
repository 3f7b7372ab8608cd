// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/box_plot.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/row_chart.hpp"

namespace isobar::report {

namespace {

constexpr double kBoxRowHeightPx = 46.0;
constexpr double kBoxHeightPx = 24.0;
constexpr double kBoxTopMarginPx = 26.0;    // for the heading "median"
constexpr double kBoxRightMarginPx = 96.0;  // for the medians
// Ratio of largest whisker to smallest median from which a linear axis would shrink the smallest box to a
// line.
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
    // Whiskers may reach down to 0: the axis starts a little below the smallest box, at most five decades
    // down.
    return Scale::logarithmic({std::max(0.4 * smallest_quartile, 1e-5 * largest), 1.3 * largest}, px_low,
                              px_high);
  }
  return Scale::linear({0.0, largest > 0.0 ? 1.06 * largest : 1.0}, px_low, px_high, kXTickPx);
}

void draw_box(Picture& picture, const BoxPlot::Row& row, const Scale& x, double y) {
  const Distribution& d = row.values;
  const Stroke stroke{row.colour, 1.6};
  picture.line({x.clamped(d.p05), y}, {x.clamped(d.q25), y}, stroke);
  picture.line({x.clamped(d.q75), y}, {x.clamped(d.p95), y}, stroke);
  const bool cut = d.p05 < x.range().low;  // no cap where a whisker leaves a logarithmic axis
  if (!cut) picture.line({x(d.p05), y - 7.0}, {x(d.p05), y + 7.0}, stroke);
  picture.line({x.clamped(d.p95), y - 7.0}, {x.clamped(d.p95), y + 7.0}, stroke);
  const Box box{x.clamped(d.q25), y - 0.5 * kBoxHeightPx, x.clamped(d.q75) - x.clamped(d.q25), kBoxHeightPx};
  picture.rect(box, "#ffffff");
  picture.rect(box, row.colour, 0.28);
  picture.outline(box, stroke);
  picture.line({x.clamped(d.median), box.y}, {x.clamped(d.median), box.bottom()}, {row.colour, 3.2});
}

}  // namespace

Picture draw(const BoxPlot& plot) {
  const RowChart chart({plot.width, kBoxRowHeightPx, kBoxTopMarginPx, kBoxRightMarginPx},
                       row_names(plot.rows));
  const Box& frame = chart.frame();
  const Scale x = scale_of(plot, frame.x, frame.right());
  Picture picture = chart.blank();
  chart.draw_axis(picture, x, plot.x_label);
  picture.text({frame.right() + 10.0, frame.y - 10.0}, "median", {12.0, "#4b5563"});
  for (std::size_t i = 0; i < plot.rows.size(); ++i) {
    const BoxPlot::Row& row = plot.rows[i];
    const double y = chart.middle(i);
    chart.draw_name(picture, i);
    const std::string median =
        is_drawn(row) ? fixed(row.values.median, plot.decimals) + " " + plot.unit : "no data";
    picture.text({frame.right() + 10.0, y + 5.0}, median, {14.0, "#1f2937", "start", true});
    if (is_drawn(row)) draw_box(picture, row, x, y);
  }
  return picture;
}

}  // namespace isobar::report
