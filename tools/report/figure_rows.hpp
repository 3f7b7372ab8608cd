// SPDX-License-Identifier: BSD-3-Clause
// The list of figures, shared by the terminal's table, the report and the JSON file.
#pragma once

#include <span>
#include <string>

#include "run/evaluation/figures.hpp"

namespace isobar::report {

struct FigureRow {
  const char* group;    ///< heading in the report's table
  const char* label;    ///< in the report's table
  const char* unit;     ///< as shown
  const char* key;      ///< in the JSON file
  const char* heading;  ///< in the terminal's table; null: left out
  int decimals;         ///< as shown
  double scale;         ///< from the stored value to the shown one
  bool is_signed;       ///< shown with its sign; the nearest to 0 is best
  bool is_ranked;       ///< the report marks the best method
  bool larger_is_better;
  double (*value)(const evaluation::MethodFigures& figures);  ///< NaN: unknown
};

std::span<const FigureRow> figure_rows();

/// The value as text in the row's unit, without the unit.
std::string shown(const FigureRow& row, const evaluation::MethodFigures& figures);

}  // namespace isobar::report
