// SPDX-License-Identifier: BSD-3-Clause
// Many recordings and methods in one table: whether one method is good everywhere.
#pragma once

#include <string>
#include <vector>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// One method on one recording.
struct ExperimentCell {
  std::string method;
  evaluation::MethodFigures figures;
  std::string failure;  ///< message of the error that ended the replay; empty: none
};

/// All methods on one recording.
struct ExperimentResult {
  std::string recording;  ///< name
  std::string failure;    ///< message of the error that left no recording; empty: none
  std::vector<ExperimentCell> cells;
  std::string figures_json;  ///< as report::figures_json() writes it; empty: none
};

/// One line a recording and method: z-RPE median, largest and last height error, ATE; the best of a recording
/// is marked. Below: each method's medians over all recordings, and in how many of them it is within 1.1 times
/// the best.
std::string experiment_table(const std::vector<ExperimentResult>& results);

/// {"command": …, "recordings": [{"name": …, "figures": …, "failures": [{"method": …, "message": …}]}]}
std::string experiment_json(const std::vector<ExperimentResult>& results, const std::string& command);

}  // namespace isobar::report
