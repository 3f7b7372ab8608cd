// SPDX-License-Identifier: BSD-3-Clause
// Two sides, configurations or runs, on the same recordings: which figures differ, and by more than they scatter.
#pragma once

#include <string>
#include <vector>

#include "core/statistics/paired.hpp"
#include "run/evaluation/figures.hpp"

namespace isobar::tools {

/// Figures of both sides on one recording.
struct ComparedRecording {
  std::string name;
  evaluation::MethodFigures first;
  evaluation::MethodFigures second;
};

enum class ComparisonVerdict { kBetter, kWorse, kWithinScatter, kUnknown };

/// One figure over all recordings, in the unit in which it is shown; errors without their sign.
struct ComparedFigure {
  std::string label;
  std::string unit;
  int decimals = 0;
  double first_median = 0.0;
  double second_median = 0.0;
  PairedDifference difference;                              ///< second minus first
  ComparisonVerdict verdict = ComparisonVerdict::kUnknown;  ///< on the second side
  bool larger_is_better = false;
};

/// Every ranked figure that both sides have on some recording. A verdict needs two recordings; equal figures are within
/// scatter.
std::vector<ComparedFigure> compare_figures(const std::vector<ComparedRecording>& recordings);

/// "better", "worse", "within scatter" or "one recording".
const char* verdict_word(ComparisonVerdict verdict);

/// As a table for the terminal; of one recording with "better here" or "worse here".
std::string comparison_table(const std::vector<ComparedFigure>& figures);

/// A sentence or two: in how many figures the second side is better, worse, the same or within scatter.
std::string comparison_summary(const std::vector<ComparedFigure>& figures);

/// As JSON: figures, and those of each recording.
std::string comparison_json(const std::vector<ComparedFigure>& figures,
                            const std::vector<ComparedRecording>& recordings, const std::string& command);

}  // namespace isobar::tools
