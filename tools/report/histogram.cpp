// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/histogram.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics/distribution.hpp"
#include "tools/report/row_chart.hpp"

namespace isobar::report {

namespace {

constexpr double kHistogramTopMarginPx = 6.0;
constexpr double kHistogramRightMarginPx = 150.0;  // for median and 99th percentile
constexpr std::size_t kBins = 80;

std::vector<double> finite_ascending(const std::vector<double>& values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept),
               [](double v) { return std::isfinite(v); });
  std::sort(kept.begin(), kept.end());
  return kept;
}

void draw_bars(Picture& picture, const Scale& x, double base, double height,
               const std::vector<double>& values, const std::string& colour) {
  std::vector<std::size_t> bins(kBins, 0);
  for (const double value : values) {
    const double share = (value - x.range().low) / (x.range().high - x.range().low);
    const double bin = std::clamp(share * static_cast<double>(kBins), 0.0, static_cast<double>(kBins - 1));
    ++bins[static_cast<std::size_t>(bin)];
  }
  const auto fullest = static_cast<double>(*std::max_element(bins.begin(), bins.end()));
  const double width = (x(x.range().high) - x(x.range().low)) / static_cast<double>(kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    const double bar = height * static_cast<double>(bins[i]) / fullest;
    if (bins[i] == 0) continue;
    picture.rect({x(x.range().low) + width * static_cast<double>(i) + 0.5, base - std::max(bar, 1.0),
                  width - 1.0, std::max(bar, 1.0)},
                 colour, 0.75);
  }
}

/// Median and 99th percentile: lines through the bars and values at the right.
void draw_quantiles(Picture& picture, const Scale& x, double base, const HistogramChart& chart, double right,
                    const std::vector<double>& sorted) {
  const double median = quantile(sorted, 0.5);
  const double p99 = quantile(sorted, 0.99);
  const double top = base - chart.row_height + 6.0;
  const double middle = base - 0.5 * chart.row_height;
  picture.line({x(median), top}, {x(median), base}, {"#111827", 1.6});
  picture.line({x(p99), top}, {x(p99), base}, {"#111827", 1.6, "4 3"});
  picture.text({right + 10.0, middle - 3.0}, "median " + fixed(median, 1) + " " + chart.unit,
               {13.0, "#1f2937", "start", true});
  picture.text({right + 10.0, middle + 15.0}, "p99 " + fixed(p99, 1) + " " + chart.unit, {13.0, "#1f2937"});
}

void draw_row(Picture& picture, const HistogramChart& chart, const RowChart& rows, const Scale& x,
              std::size_t i, const std::vector<double>& sorted) {
  const Box& frame = rows.frame();
  const double base = rows.bottom(i);
  picture.line({frame.x, base}, {frame.right(), base}, {"#9ca3af"});
  rows.draw_name(picture, i);
  if (sorted.empty()) {
    picture.text({frame.x + 12.0, rows.middle(i) + 5.0}, "no times recorded", {13.0, "#6b7280"});
    return;
  }
  draw_bars(picture, x, base, chart.row_height - 12.0, sorted, chart.rows[i].colour);
  draw_quantiles(picture, x, base, chart, frame.right(), sorted);
}

}  // namespace

Picture draw(const HistogramChart& chart) {
  double largest = 0.0;
  std::vector<std::vector<double>> sorted;
  for (const HistogramChart::Row& row : chart.rows) {
    sorted.push_back(finite_ascending(row.values));
    if (!sorted.back().empty()) largest = std::max(largest, 1.3 * quantile(sorted.back(), 0.99));
  }
  const RowChart rows({chart.width, chart.row_height, kHistogramTopMarginPx, kHistogramRightMarginPx},
                      row_names(chart.rows));
  const Scale x =
      Scale::linear({0.0, largest > 0.0 ? largest : 1.0}, rows.frame().x, rows.frame().right(), kXTickPx);
  Picture picture = rows.blank();
  rows.draw_axis(picture, x, chart.x_label);
  for (std::size_t i = 0; i < chart.rows.size(); ++i) draw_row(picture, chart, rows, x, i, sorted[i]);
  return picture;
}

}  // namespace isobar::report
