// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/statistics/distribution.hpp"
#include "tools/report/scale.hpp"

namespace isobar::report {

/// One box per row: median, quartiles, whiskers from the 5th to the 95th percentile, the median's value at
/// the right. The axis is logarithmic when the largest whisker exceeds 25 times the smallest median.
struct BoxPlot {
  struct Row {
    std::string name;
    std::string colour;
    Distribution values;
  };

  std::string x_label;
  std::string unit;  ///< of the median's value
  int decimals = 2;  ///< of the median's value
  std::vector<Row> rows;
  double width = 1040.0;
};

Picture draw(const BoxPlot& plot);

}  // namespace isobar::report
