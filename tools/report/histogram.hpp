// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/report/scale.hpp"

namespace isobar::report {

/// One histogram per row over a common axis, with median and 99th percentile marked. Values beyond the axis
/// are counted in its last bin.
struct HistogramChart {
  struct Row {
    std::string name;
    std::string colour;
    std::vector<double> values;  ///< those that are not finite are left out
  };

  std::string x_label;
  std::string unit;
  std::vector<Row> rows;
  double width = 1040.0;
  double row_height = 74.0;
};

Picture draw(const HistogramChart& chart);

}  // namespace isobar::report
