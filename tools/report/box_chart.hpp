// SPDX-License-Identifier: BSD-3-Clause
// A box plot as data; tools/web/page/src/box_chart.ts draws it.
#pragma once

#include <string>
#include <vector>

#include "core/statistics/distribution.hpp"

namespace isobar::report {

/// One box per row: median, quartiles, whiskers from the 5th to the 95th percentile, the median's value at the right.
struct BoxChart {
  struct Row {
    std::string name;
    std::string colour;
    Distribution values;  ///< ≥ 0
  };

  std::string x_label;
  std::string unit;  ///< of the median's value
  int decimals = 2;  ///< of the median's value
  std::vector<Row> rows;
};

/// The x axis of a box plot.
struct BoxAxis {
  double low = 0.0;
  double high = 1.0;
  bool is_logarithmic = false;  ///< where the largest whisker exceeds 25 times the smallest median
};
BoxAxis axis_of(const BoxChart& chart);

/// The chart as JSON; a row without values has a null median.
std::string chart_json(const BoxChart& chart);

}  // namespace isobar::report
