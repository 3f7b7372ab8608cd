// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/box_chart.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace isobar::report {

namespace {

using Json = nlohmann::ordered_json;

// Ratio of largest whisker to smallest median from which a linear axis would shrink the smallest box to a line.
constexpr double kLogarithmicFrom = 25.0;

bool is_drawn(const BoxChart::Row& row) { return row.values.count > 0 && std::isfinite(row.values.median); }

}  // namespace

BoxAxis axis_of(const BoxChart& chart) {
  double largest = 0.0;
  double smallest_median = INFINITY;
  double smallest_quartile = INFINITY;
  for (const BoxChart::Row& row : chart.rows) {
    if (!is_drawn(row)) continue;
    largest = std::max(largest, row.values.p95);
    if (row.values.median > 0.0) smallest_median = std::min(smallest_median, row.values.median);
    if (row.values.q25 > 0.0) smallest_quartile = std::min(smallest_quartile, row.values.q25);
  }
  if (std::isfinite(smallest_quartile) && largest > kLogarithmicFrom * smallest_median) {
    // Whiskers may reach down to 0: the axis starts a little below the smallest box, at most five decades down.
    return {std::max(0.4 * smallest_quartile, 1e-5 * largest), 1.3 * largest, true};
  }
  return {0.0, largest > 0.0 ? 1.06 * largest : 1.0, false};
}

std::string chart_json(const BoxChart& chart) {
  const BoxAxis axis = axis_of(chart);
  Json json{{"kind", "boxes"},
            {"x_label", chart.x_label},
            {"unit", chart.unit},
            {"decimals", chart.decimals},
            {"range", {axis.low, axis.high}},
            {"logarithmic", axis.is_logarithmic},
            {"rows", Json::array()}};
  for (const BoxChart::Row& row : chart.rows) {
    Json box{{"name", row.name}, {"colour", row.colour}, {"median", nullptr}};
    if (is_drawn(row)) {
      const Distribution& d = row.values;
      box.update({{"p05", d.p05}, {"q25", d.q25}, {"median", d.median}, {"q75", d.q75}, {"p95", d.p95}});
    }
    json["rows"].push_back(std::move(box));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace isobar::report
