// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/map_view.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::report {

namespace {

constexpr double kMapLeftMargin = 68.0;
constexpr double kMapBottomMargin = 50.0;
constexpr double kShades = 48.0;
constexpr double kImagePixelsPerPx = 1.5;  // sharp on denser screens and in print

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

/// What goes right of the frame: the levels' labels. The same for all, so that views can be compared.
double right_margin(const MapView& view) { return view.levels.empty() ? 14.0 : 84.0; }

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
  const double width_m = view.u.high - view.u.low;
  const double height_m = view.v_exaggeration * (view.v.high - view.v.low);
  const double margin = right_margin(view);
  std::vector<LegendEntry> legend;
  for (const Series& path : view.paths) {
    if (view.legend && !path.name.empty()) legend.push_back({path.name, path.stroke});
  }
  const double available = view.width - kMapLeftMargin - margin;
  const double px_per_m = std::min(available / width_m, view.max_height / height_m);
  const double top = legend_height(available, legend) + 8.0;
  const Box frame{kMapLeftMargin + 0.5 * (available - px_per_m * width_m), top, px_per_m * width_m,
                  px_per_m * height_m};
  Picture picture(view.width, top + frame.height + kMapBottomMargin);
  draw_legend(picture, {kMapLeftMargin, 0.0}, available, legend);
  const Axes axes{frame, Scale::linear(view.u, frame.x, frame.right(), 90.0),
                  Scale::linear(view.v, frame.bottom(), frame.y, 44.0), view.u_label, view.v_label};
  draw_axes(picture, axes);
  const auto pixels = [](double px) {
    return static_cast<std::size_t>(std::max(1.0, std::round(kImagePixelsPerPx * px)));
  };
  if (!view.points.empty()) {
    picture.image(frame, png_data_uri(density_image(view.points, view.u, view.v, pixels(frame.width),
                                                    pixels(frame.height))));
  }
  for (const LevelMark& level : view.levels) {
    const double y = axes.y(level.v);
    picture.line({frame.x, y}, {frame.right() + 6.0, y}, {"#b91c1c", 1.0, "5 4", 0.8});
    picture.text({frame.right() + 10.0, y + 4.0}, level.label, {12.0, "#7f1d1d"});
  }
  picture.begin_clip(frame, view.id);
  for (const Series& path : view.paths) {
    std::vector<Point> line;
    for (std::size_t i = 0; i < path.x.size(); ++i) {
      const Point p{axes.x(path.x[i]), axes.y(path.y[i])};
      const bool moved = line.empty() || std::hypot(p.x - line.back().x, p.y - line.back().y) > 0.7;
      if (moved) line.push_back(p);
    }
    picture.polyline(simplified(line, 0.15), path.stroke);
  }
  picture.end_clip();
  return picture;
}

}  // namespace isobar::report
