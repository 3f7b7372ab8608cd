// SPDX-License-Identifier: BSD-3-Clause
// Result of `isobar calibrate`: a table for the terminal, and a page with the paper's box plot.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/calibration/calibration.hpp"

namespace isobar::report {

struct CalibrationReport {
  std::string title;
  std::string command;  ///< the command line that makes this report
  Calibration calibration;
  CompensationModel chosen = CompensationModel::kNone;  ///< the model written to the file
  std::vector<CalibrationRecording> recordings;
  std::vector<std::string> notes;     ///< how the data were read and paired
  std::vector<std::string> warnings;  ///< in addition to the calibration's
};

/// For the terminal: number and range of the samples, the table of all models, and the recommendation.
std::string calibration_table(const Calibration& calibration,
                              std::span<const CalibrationRecording> recordings);

/// The page as HTML.
std::string render_calibration_report(const CalibrationReport& report);

}  // namespace isobar::report
