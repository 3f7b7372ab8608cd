// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/line_chart.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isobar::report {

namespace {

constexpr double kLegendGapPx = 8.0;
constexpr double kBandLabelHeightPx = 22.0;
constexpr double kInvisiblePx = 0.15;  // displacement of a line that no screen shows
constexpr const char* kBandColour = "#eef2f7";

void draw_bands(Picture& picture, const LineChart& chart, const Axes& axes) {
  for (const Band& band : chart.bands) {
    const double from = axes.x.clamped(band.from);
    const double to = axes.x.clamped(band.to);
    if (to - from < 0.5) continue;
    if (band.shaded) picture.rect({from, axes.frame.y, to - from, axes.frame.height}, kBandColour);
    if (to - from > text_width(band.label, 12.0) - 4.0) {
      picture.text({0.5 * (from + to), axes.frame.y - 5.0}, band.label, {12.0, "#4b5563", "middle"});
    }
  }
}

void draw_series(Picture& picture, const Series& series, const Axes& axes) {
  std::vector<Point> run;
  const std::size_t count = std::min(series.x.size(), series.y.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Point point{axes.x(series.x[i]), axes.y(series.y[i])};
    if (std::isfinite(point.x) && std::isfinite(point.y)) {
      run.push_back(point);
      continue;
    }
    picture.polyline(simplified(thinned(run), kInvisiblePx), series.stroke);
    run.clear();
  }
  picture.polyline(simplified(thinned(run), kInvisiblePx), series.stroke);
}

void draw_ribbon(Picture& picture, const Ribbon& ribbon, const Axes& axes) {
  const auto edge = [&](const std::vector<double>& y) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < std::min(ribbon.x.size(), y.size()); ++i) {
      const Point point{axes.x(ribbon.x[i]), axes.y(y[i])};
      if (std::isfinite(point.x) && std::isfinite(point.y)) points.push_back(point);
    }
    return simplified(thinned(points), kInvisiblePx);
  };
  std::vector<Point> outline = edge(ribbon.low);
  const std::vector<Point> high = edge(ribbon.high);
  outline.insert(outline.end(), high.rbegin(), high.rend());
  picture.polygon(outline, ribbon.colour);
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  if (length == 0.0) return std::hypot(p.x - a.x, p.y - a.y);
  const double along = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / (length * length);
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x - a.x - t * (b.x - a.x), p.y - a.y - t * (b.y - a.y));
}

Range data_range(const LineChart& chart, const std::vector<double> Series::*values) {
  std::vector<double> all;
  for (const Series& series : chart.series)
    all.insert(all.end(), (series.*values).begin(), (series.*values).end());
  if (values == &Series::y) {
    for (const Ribbon& ribbon : chart.ribbons) {
      all.insert(all.end(), ribbon.low.begin(), ribbon.low.end());
      all.insert(all.end(), ribbon.high.begin(), ribbon.high.end());
    }
  }
  return range_of(all);
}

Axes axes_of(const LineChart& chart, const Box& frame) {
  const Range x = chart.x_range.value_or(data_range(chart, &Series::x));
  const Range all_y = data_range(chart, &Series::y);
  if (chart.is_logarithmic) {
    const Range y = chart.y_range.value_or(Range{0.8 * all_y.low, 1.25 * all_y.high});
    return {frame, Scale::logarithmic(x, frame.x, frame.right()),
            Scale::logarithmic(y, frame.bottom(), frame.y), chart.x_label, chart.y_label};
  }
  const Range y = chart.y_range.value_or(padded(all_y, 0.06, chart.min_y_width));
  return {frame, Scale::linear(padded(x, 0.0), frame.x, frame.right(), kXTickPx),
          Scale::linear(y, frame.bottom(), frame.y, kYTickPx), chart.x_label, chart.y_label};
}

}  // namespace

std::vector<Point> thinned(const std::vector<Point>& points) {
  std::vector<Point> kept;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin + 1;
    while (end < points.size() && std::floor(points[end].x) == std::floor(points[begin].x)) ++end;
    std::size_t low = begin;
    std::size_t high = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (points[i].y < points[low].y) low = i;
      if (points[i].y > points[high].y) high = i;
    }
    std::vector<std::size_t> chosen{begin, std::min(low, high), std::max(low, high), end - 1};
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const std::size_t i : chosen) kept.push_back(points[i]);
    begin = end;
  }
  return kept;
}

std::vector<Point> simplified(const std::vector<Point>& points, double tolerance_px) {
  if (points.size() < 3) return points;
  std::vector<bool> stays(points.size(), false);
  stays.front() = stays.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, points.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    std::size_t furthest = first;
    double largest = tolerance_px;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to_segment(points[i], points[first], points[last]);
      if (distance <= largest) continue;
      largest = distance;
      furthest = i;
    }
    if (furthest == first) continue;
    stays[furthest] = true;
    spans.emplace_back(first, furthest);
    spans.emplace_back(furthest, last);
  }
  std::vector<Point> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (stays[i]) kept.push_back(points[i]);
  }
  return kept;
}

std::vector<LegendEntry> legend_of(const std::vector<Series>& lines) {
  std::vector<LegendEntry> legend;
  for (const Series& series : lines) {
    if (!series.name.empty()) legend.push_back({series.name, series.stroke});
  }
  return legend;
}

Picture draw(const LineChart& chart) {
  Picture picture(chart.width, chart.height);
  const Box frame = frame_below_legend(picture, legend_of(chart.series),
                                       chart.bands.empty() ? kLegendGapPx : kBandLabelHeightPx);
  const Axes axes = axes_of(chart, frame);
  draw_bands(picture, chart, axes);
  draw_axes(picture, axes);
  picture.begin_clip(frame, chart.id);
  for (const Ribbon& ribbon : chart.ribbons) draw_ribbon(picture, ribbon, axes);
  if (chart.zero_line) {
    picture.line({frame.x, axes.y(0.0)}, {frame.right(), axes.y(0.0)}, {"#6b7280", 1.0});
  }
  for (const bool on_top : {false, true}) {
    for (const Series& series : chart.series) {
      if (series.on_top == on_top) draw_series(picture, series, axes);
    }
  }
  picture.end_clip();
  return picture;
}

}  // namespace isobar::report
