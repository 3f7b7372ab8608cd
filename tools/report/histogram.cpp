// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/histogram.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics/distribution.hpp"

namespace isobar::report {

namespace {

constexpr double kHistogramTopMargin = 6.0;
constexpr double kHistogramBottomMargin = 50.0;
constexpr double kHistogramRightMargin = 150.0;
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

}  // namespace

Picture draw(const HistogramChart& chart) {
  double left = 60.0;
  double largest = 0.0;
  std::vector<std::vector<double>> sorted;
  for (const HistogramChart::Row& row : chart.rows) {
    left = std::max(left, text_width(row.name, 14.0) + 18.0);
    sorted.push_back(finite_ascending(row.values));
    if (!sorted.back().empty()) largest = std::max(largest, 1.3 * quantile(sorted.back(), 0.99));
  }
  const double inner = chart.row_height * static_cast<double>(chart.rows.size());
  Picture picture(chart.width, kHistogramTopMargin + inner + kHistogramBottomMargin);
  const Box frame{left, kHistogramTopMargin, chart.width - left - kHistogramRightMargin, inner};
  const Axes axes{frame,
                  Scale::linear({0.0, largest > 0.0 ? largest : 1.0}, frame.x, frame.right(), 90.0),
                  Scale::linear({0.0, 1.0}, frame.bottom(), frame.y, frame.height),
                  chart.x_label,
                  "",
                  false,
                  false};
  draw_axes(picture, axes);
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    const HistogramChart::Row& row = chart.rows[i];
    const double base = kHistogramTopMargin + chart.row_height * static_cast<double>(i + 1);
    const double middle = base - 0.5 * chart.row_height;
    picture.line({frame.x, base}, {frame.right(), base}, {"#9ca3af"});
    picture.text({left - 10.0, middle + 5.0}, row.name, {14.0, "#1f2937", "end"});
    if (sorted[i].empty()) {
      picture.text({frame.x + 12.0, middle + 5.0}, "no times recorded", {13.0, "#6b7280"});
      continue;
    }
    draw_bars(picture, axes.x, base, chart.row_height - 12.0, sorted[i], row.colour);
    const double median = quantile(sorted[i], 0.5);
    const double p99 = quantile(sorted[i], 0.99);
    const double top = base - chart.row_height + 6.0;
    picture.line({axes.x(median), top}, {axes.x(median), base}, {"#111827", 1.6});
    picture.line({axes.x(p99), top}, {axes.x(p99), base}, {"#111827", 1.6, "4 3"});
    picture.text({frame.right() + 10.0, middle - 3.0}, "median " + fixed(median, 1) + " " + chart.unit,
                 {13.0, "#1f2937", "start", true});
    picture.text({frame.right() + 10.0, middle + 15.0}, "p99 " + fixed(p99, 1) + " " + chart.unit,
                 {13.0, "#1f2937"});
  }
  return picture;
}

}  // namespace isobar::report
