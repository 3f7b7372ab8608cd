// SPDX-License-Identifier: BSD-3-Clause
// The few SVG elements that the charts are made of. Lengths are pixels, y points down.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace isobar::report {

/// Escapes text for use between tags and in attributes; drops control characters.
std::string escaped(std::string_view text);

/// A number with fixed decimals; "–" for NaN; "0", never "-0".
std::string fixed(double value, int decimals);

/// Like fixed(), with a plus sign for positive numbers and U+2212 as minus sign.
std::string fixed_signed(double value, int decimals);

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] double right() const { return x + width; }
  [[nodiscard]] double bottom() const { return y + height; }
};

struct Stroke {
  std::string colour = "#1f2937";
  double width = 1.0;
  std::string dash{};  ///< stroke-dasharray; empty: solid line
  double opacity = 1.0;
};

struct TextStyle {
  double size = 13.0;
  std::string colour = "#1f2937";
  std::string anchor = "start";  ///< "start", "middle" or "end"
  bool bold = false;
  double rotate_deg = 0.0;
  bool halo = false;  ///< white outline, for text over lines
};

/// An SVG drawing of a given size [px].
class Picture {
 public:
  Picture(double width, double height) : width_(width), height_(height) {}

  void line(Point a, Point b, const Stroke& stroke);
  /// Fewer than two points draw nothing.
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  /// Area within a closed polygon.
  void polygon(const std::vector<Point>& points, std::string_view fill);
  void rect(const Box& box, std::string_view fill, double opacity = 1.0, double radius = 0.0);
  void outline(const Box& box, const Stroke& stroke, std::string_view fill = "none");
  void circle(Point centre, double radius, std::string_view fill, const Stroke& stroke);
  void text(Point at, std::string_view content, const TextStyle& style = {});
  /// Stretches an image, given as a data URI, over the box.
  void image(const Box& box, std::string_view data_uri);
  /// Draws another picture with its corner at `at`.
  void place(const Picture& picture, Point at);
  /// Clips what is drawn until end_clip() to the box. Does not nest. `id` must be unique in the page.
  void begin_clip(const Box& box, std::string_view id);
  void end_clip();

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  /// The <svg> element; `title` is read by screen readers.
  [[nodiscard]] std::string svg(std::string_view title) const;

 private:
  double width_;
  double height_;
  std::string body_;
};

/// Approximate width of a text in the report's sans-serif typeface [px], to some 10 %.
double text_width(std::string_view content, double size);

}  // namespace isobar::report
