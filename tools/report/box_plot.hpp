// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/statistics/distribution.hpp"
#include "tools/report/scale.hpp"

namespace isobar::report {

/// One box a row: median, quartiles, whiskers from the 5th to the 95th percentile, the median in figures at
/// the right. The axis is logarithmic if the largest whisker is more than 25 times the smallest median.
struct BoxPlot {
  struct Row {
    std::string name;
    std::string colour;
    Distribution values;
  };

  std::string x_label;
  std::string unit;  ///< behind the median in figures
  int decimals = 2;  ///< of that
  std::vector<Row> rows;
  double width = 1040.0;
};

Picture draw(const BoxPlot& plot);

}  // namespace isobar::report
