// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/report/scale.hpp"

namespace isobar::report {

/// Room around and inside the frame of a chart of rows [px].
struct RowLayout {
  double width = 1040.0;
  double row_height = 0.0;
  double top_margin = 0.0;
  double right_margin = 0.0;  ///< for figures beside the rows
};

/// A chart of named rows over a common x axis: names left of the frame, figures right of it.
class RowChart {
 public:
  RowChart(const RowLayout& layout, std::vector<std::string> names);

  [[nodiscard]] const Box& frame() const { return frame_; }
  [[nodiscard]] double middle(std::size_t row) const;
  [[nodiscard]] double bottom(std::size_t row) const;
  /// Draws the frame, the x axis and its label.
  void draw_axis(Picture& picture, const Scale& x, const std::string& label) const;
  void draw_name(Picture& picture, std::size_t row) const;
  /// An empty picture with room for all rows and the x axis.
  [[nodiscard]] Picture blank() const;

 private:
  RowLayout layout_;
  std::vector<std::string> names_;
  Box frame_;
};

/// The names of rows, for RowChart.
template <typename Row>
std::vector<std::string> row_names(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  names.reserve(rows.size());
  for (const Row& row : rows) names.push_back(row.name);
  return names;
}

}  // namespace isobar::report
