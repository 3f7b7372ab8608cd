// SPDX-License-Identifier: BSD-3-Clause
// What `isobar calibrate` found: a table for the terminal and a page with the paper's box plot.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/calibration/calibration.hpp"

namespace isobar::report {

struct CalibrationReport {
  std::string title;
  std::string command;  ///< that makes this report again, as typed
  Calibration calibration;
  CompensationModel chosen = CompensationModel::kNone;  ///< the one that was written
  std::vector<CalibrationRecording> recordings;
  std::vector<std::string> notes;     ///< how the data were read and paired
  std::vector<std::string> warnings;  ///< beside the calibration's own
};

/// The table of all models, and what stands below it: samples, spans, recommendation, warnings.
std::string calibration_table(const Calibration& calibration,
                              std::span<const CalibrationRecording> recordings);

/// The whole page.
std::string render_calibration_report(const CalibrationReport& report);

}  // namespace isobar::report
