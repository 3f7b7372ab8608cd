// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/map_view.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::report {

namespace {

constexpr double kLevelLabelPx = 84.0;  // room right of the frame for the labels of floors
constexpr double kMapLegendGapPx = 8.0;
constexpr double kShades = 48.0;           // shades of grey, the first is transparent
constexpr double kImagePixelsPerPx = 1.5;  // oversampling, for dense screens and print
constexpr double kMinMovePx = 0.7;         // points of a path that are closer are not drawn

std::vector<std::array<std::uint8_t, 4>> grey_palette() {
  std::vector<std::array<std::uint8_t, 4>> palette{{255, 255, 255, 0}};
  for (double i = 1.0; i < kShades; i += 1.0) {
    const double dark = std::sqrt(i / (kShades - 1.0));
    const auto channel = [&](double light, double deep) {
      return static_cast<std::uint8_t>(std::lround(light + dark * (deep - light)));
    };
    palette.push_back({channel(214, 55), channel(219, 65), channel(226, 81), 255});
  }
  return palette;
}

/// Number of points at the 98th percentile of the pixels that have any.
double bright_count(const std::vector<std::uint32_t>& counts) {
  std::vector<std::uint32_t> hit;
  std::copy_if(counts.begin(), counts.end(), std::back_inserter(hit), [](std::uint32_t n) { return n > 0; });
  if (hit.empty()) return 1.0;
  const auto rank =
      hit.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.98 * static_cast<double>(hit.size() - 1)));
  std::nth_element(hit.begin(), rank, hit.end());
  return static_cast<double>(*rank);
}

/// Constant, not the width of the labels, so that two views have the same scale and can be compared.
double right_margin(const MapView& view) { return view.levels.empty() ? kRightMarginPx : kLevelLabelPx; }

/// The frame of the view, to scale and centred between the margins.
Box frame_of(const MapView& view, double available_px, double top_px) {
  const double width_m = view.u.high - view.u.low;
  const double height_m = view.v_exaggeration * (view.v.high - view.v.low);
  const double px_per_m = std::min(available_px / width_m, view.max_height / height_m);
  return {kLeftMarginPx + 0.5 * (available_px - px_per_m * width_m), top_px, px_per_m * width_m,
          px_per_m * height_m};
}

void draw_points(Picture& picture, const MapView& view, const Box& frame) {
  if (view.points.empty()) return;
  const auto pixels = [](double px) {
    return static_cast<std::size_t>(std::max(1.0, std::round(kImagePixelsPerPx * px)));
  };
  picture.image(frame, png_data_uri(density_image(view.points, view.u, view.v, pixels(frame.width),
                                                  pixels(frame.height))));
}

void draw_level(Picture& picture, const LevelMark& level, const Axes& axes) {
  const double y = axes.y(level.v);
  const double right = axes.frame.right();
  picture.line({axes.frame.x, y}, {right + 6.0, y}, {"#b91c1c", 1.0, "5 4", 0.8});
  picture.text({right + 10.0, y + 4.0}, level.label, {12.0, "#7f1d1d"});
}

void draw_path(Picture& picture, const Series& path, const Axes& axes) {
  std::vector<Point> line;
  for (std::size_t i = 0; i < path.x.size(); ++i) {
    const Point p{axes.x(path.x[i]), axes.y(path.y[i])};
    const bool moved = line.empty() || std::hypot(p.x - line.back().x, p.y - line.back().y) > kMinMovePx;
    if (moved) line.push_back(p);
  }
  picture.polyline(simplified(line, 0.15), path.stroke);
}

}  // namespace

IndexedImage density_image(const std::vector<MapPoint>& points, const Range& u, const Range& v,
                           std::size_t width, std::size_t height) {
  IndexedImage image{width, height, std::vector<std::uint8_t>(width * height, 0), grey_palette()};
  std::vector<std::uint32_t> counts(width * height, 0);
  for (const MapPoint& point : points) {
    const double column = (point.u - u.low) / (u.high - u.low) * static_cast<double>(width);
    const double row = (v.high - point.v) / (v.high - v.low) * static_cast<double>(height);
    if (!(column >= 0.0 && row >= 0.0)) continue;
    if (column >= static_cast<double>(width) || row >= static_cast<double>(height)) continue;
    ++counts[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
  }
  const double bright = std::log1p(bright_count(counts));
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const double shade = std::min(1.0, std::log1p(static_cast<double>(counts[i])) / bright);
    image.pixels[i] = static_cast<std::uint8_t>(1.0 + shade * (kShades - 2.0));
  }
  return image;
}

Picture draw(const MapView& view) {
  const std::vector<LegendEntry> legend = legend_of(view.paths);
  const double available_px = view.width - kLeftMarginPx - right_margin(view);
  const Box frame = frame_of(view, available_px, legend_height(available_px, legend) + kMapLegendGapPx);
  Picture picture(view.width, frame.bottom() + kBottomMarginPx);
  draw_legend(picture, {kLeftMarginPx, 0.0}, available_px, legend);
  const Axes axes{frame, Scale::linear(view.u, frame.x, frame.right(), kXTickPx),
                  Scale::linear(view.v, frame.bottom(), frame.y, kYTickPx), view.u_label, view.v_label};
  draw_axes(picture, axes);
  draw_points(picture, view, frame);
  for (const LevelMark& level : view.levels) draw_level(picture, level, axes);
  picture.begin_clip(frame, view.id);
  for (const Series& path : view.paths) draw_path(picture, path, axes);
  picture.end_clip();
  return picture;
}

}  // namespace isobar::report
