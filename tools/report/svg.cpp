// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/svg.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace isobar::report {

namespace {

constexpr std::string_view kMinus = "\u2212";

/// A coordinate or length with a tenth of a pixel.
std::string px(double value) { return fixed(value, 1); }

std::string stroke_attributes(const Stroke& stroke) {
  std::string text = " stroke=\"" + stroke.colour + "\" stroke-width=\"" + fixed(stroke.width, 2) + "\"";
  if (!stroke.dash.empty()) text += " stroke-dasharray=\"" + stroke.dash + "\"";
  if (stroke.opacity < 1.0) text += " stroke-opacity=\"" + fixed(stroke.opacity, 2) + "\"";
  return text;
}

std::string box_attributes(const Box& box) {
  return "x=\"" + px(box.x) + "\" y=\"" + px(box.y) + "\" width=\"" + px(box.width) + "\" height=\"" +
         px(box.height) + "\"";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') result += c;
    }
  }
  return result;
}

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) return "\u2013";
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  std::string result(text.data());
  if (result.front() == '-' && result.find_first_not_of("-0.") == std::string::npos) result.erase(0, 1);
  return result;
}

std::string fixed_signed(double value, int decimals) {
  std::string text = fixed(value, decimals);
  if (std::isnan(value) || text.find_first_of("123456789") == std::string::npos) return text;
  if (text.front() == '-') return std::string(kMinus) + text.substr(1);
  return "+" + text;
}

void Picture::line(Point a, Point b, const Stroke& stroke) {
  body_ += "<line x1=\"" + px(a.x) + "\" y1=\"" + px(a.y) + "\" x2=\"" + px(b.x) + "\" y2=\"" + px(b.y) +
           "\"" + stroke_attributes(stroke) + "/>\n";
}

void Picture::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  if (points.size() < 2) return;
  body_ += "<polyline fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\"" +
           stroke_attributes(stroke) + " points=\"";
  for (const Point& p : points) body_ += px(p.x) + "," + px(p.y) + " ";
  body_.back() = '"';
  body_ += "/>\n";
}

void Picture::polygon(const std::vector<Point>& points, std::string_view fill) {
  if (points.size() < 3) return;
  body_ += "<polygon fill=\"" + std::string(fill) + "\" points=\"";
  for (const Point& p : points) body_ += px(p.x) + "," + px(p.y) + " ";
  body_.back() = '"';
  body_ += "/>\n";
}

void Picture::rect(const Box& box, std::string_view fill, double opacity, double radius) {
  body_ += "<rect " + box_attributes(box) + " fill=\"" + std::string(fill) + "\"";
  if (radius > 0.0) body_ += " rx=\"" + px(radius) + "\"";
  if (opacity < 1.0) body_ += " fill-opacity=\"" + fixed(opacity, 2) + "\"";
  body_ += "/>\n";
}

void Picture::outline(const Box& box, const Stroke& stroke, std::string_view fill) {
  body_ += "<rect " + box_attributes(box) + " fill=\"" + std::string(fill) + "\"" +
           stroke_attributes(stroke) + "/>\n";
}

void Picture::circle(Point centre, double radius, std::string_view fill, const Stroke& stroke) {
  body_ += "<circle cx=\"" + px(centre.x) + "\" cy=\"" + px(centre.y) + "\" r=\"" + px(radius) +
           "\" fill=\"" + std::string(fill) + "\"" + stroke_attributes(stroke) + "/>\n";
}

void Picture::text(Point at, std::string_view content, const TextStyle& style) {
  body_ += "<text x=\"" + px(at.x) + "\" y=\"" + px(at.y) + "\" font-size=\"" + px(style.size) +
           "\" fill=\"" + style.colour + "\"";
  if (style.anchor != "start") body_ += " text-anchor=\"" + style.anchor + "\"";
  if (style.bold) body_ += " font-weight=\"600\"";
  if (style.halo)
    body_ += " stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\" stroke-linejoin=\"round\"";
  if (style.rotate_deg != 0.0) {
    body_ += " transform=\"rotate(" + px(style.rotate_deg) + " " + px(at.x) + " " + px(at.y) + ")\"";
  }
  body_ += ">" + escaped(content) + "</text>\n";
}

void Picture::image(const Box& box, std::string_view data_uri) {
  body_ += "<image " + box_attributes(box) + " preserveAspectRatio=\"none\" href=\"" + std::string(data_uri) +
           "\"/>\n";
}

void Picture::place(const Picture& picture, Point at) {
  body_ += "<g transform=\"translate(" + px(at.x) + " " + px(at.y) + ")\">\n" + picture.body_ + "</g>\n";
}

void Picture::begin_clip(const Box& box, std::string_view id) {
  body_ += "<clipPath id=\"" + escaped(id) + "\"><rect " + box_attributes(box) +
           "/></clipPath>\n<g clip-path=\"url(#" + escaped(id) + ")\">\n";
}

void Picture::end_clip() { body_ += "</g>\n"; }

std::string Picture::svg(std::string_view title) const {
  const std::string size = px(width_) + " " + px(height_);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" + px(width_) +
         "\" height=\"" + px(height_) +
         "\" role=\"img\" font-family=\"system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', Helvetica, Arial, "
         "sans-serif\">\n" +
         "<title>" + escaped(title) + "</title>\n" + body_ + "</svg>\n";
}

double text_width(std::string_view content, double size) {
  double letters = 0.0;
  for (const char c : content) {
    if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) letters += 1.0;  // not a UTF-8 continuation
  }
  return 0.58 * size * letters;
}

}  // namespace isobar::report
