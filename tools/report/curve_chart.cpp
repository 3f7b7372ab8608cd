// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/curve_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace isobar::report {

namespace {

using Json = nlohmann::ordered_json;

// Spans of x: some more than a screen has pixels.
constexpr std::size_t kSpans = 1500;
constexpr std::size_t kPerSpan = 4;

/// With eight digits: a value takes half the bytes, and an hour still has its milliseconds.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.8g", value);
  return std::strtod(text.data(), nullptr);
}

Json column(const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  Json json = Json::array();
  for (const std::size_t row : rows) json.push_back(rounded(values[row]));
  return json;
}

Json curve_json(const Curve& curve) {
  const std::vector<std::size_t> rows = rows_to_keep(curve.x, curve.y);
  return {{"name", curve.name},          {"colour", curve.stroke.colour},
          {"width", curve.stroke.width}, {"dash", dash_lengths(curve.stroke)},
          {"stepped", curve.is_stepped}, {"x", column(curve.x, rows)},
          {"y", column(curve.y, rows)}};
}

Json area_json(const Area& area) {
  const std::vector<std::size_t> rows = rows_to_keep(area.x, area.high);
  return {{"colour", area.colour},
          {"x", column(area.x, rows)},
          {"low", column(area.low, rows)},
          {"high", column(area.high, rows)}};
}

Json range_json(const std::optional<std::array<double, 2>>& range) {
  return range ? Json{(*range)[0], (*range)[1]} : Json(nullptr);
}

}  // namespace

std::vector<std::size_t> rows_to_keep(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::size_t> rows;
  const std::size_t count = std::min(x.size(), y.size());
  if (count <= kSpans * kPerSpan) {
    for (std::size_t row = 0; row < count; ++row) rows.push_back(row);
    return rows;
  }
  const double width = (x[count - 1] - x.front()) / static_cast<double>(kSpans);
  for (std::size_t begin = 0; begin < count;) {
    std::size_t lowest = begin;
    std::size_t highest = begin;
    std::size_t end = begin + 1;
    for (; end < count && x[end] < x[begin] + width; ++end) {
      if (std::isnan(y[lowest]) || y[end] < y[lowest]) lowest = end;
      if (std::isnan(y[highest]) || y[end] > y[highest]) highest = end;
    }
    for (const std::size_t row : {begin, std::min(lowest, highest), std::max(lowest, highest), end - 1}) {
      if (rows.empty() || row > rows.back()) rows.push_back(row);
    }
    begin = end;
  }
  return rows;
}

std::string chart_json(const CurveChart& chart) {
  Json json{{"kind", "curves"},
            {"x_label", chart.x_label},
            {"y_label", chart.y_label},
            {"x_unit", chart.x_unit},
            {"y_unit", chart.y_unit},
            {"y_decimals", chart.y_decimals},
            {"curves", Json::array()},
            {"areas", Json::array()},
            {"dots", Json::array()},
            {"spans", Json::array()},
            {"x_range", range_json(chart.x_range)},
            {"y_range", range_json(chart.y_range)},
            {"logarithmic", chart.is_logarithmic}};
  for (const Curve& curve : chart.curves) json["curves"].push_back(curve_json(curve));
  for (const Area& area : chart.areas) json["areas"].push_back(area_json(area));
  for (const Dots& dots : chart.dots) {
    std::vector<std::size_t> all(dots.x.size());
    for (std::size_t row = 0; row < all.size(); ++row) all[row] = row;
    json["dots"].push_back({{"colour", dots.colour}, {"x", column(dots.x, all)}, {"y", column(dots.y, all)}});
  }
  for (const Span& span : chart.spans)
    json["spans"].push_back({{"from", rounded(span.from)}, {"to", rounded(span.to)}, {"label", span.label}});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace isobar::report
