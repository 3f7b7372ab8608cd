// SPDX-License-Identifier: BSD-3-Clause
// The report: one HTML file that needs neither network nor scripts.
#pragma once

#include <filesystem>
#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

struct ReportInput {
  std::string title;        ///< what was measured: "Three floors, seed 1"
  std::string description;  ///< a sentence or two below it; may be empty
  std::string command;      ///< that makes this report again, as typed
  evaluation::EvaluatedRun run;
};

std::string render_report(const ReportInput& input);

/// render_report() into a file. Throws ServiceError if it cannot be written.
void write_report(const std::filesystem::path& file, const ReportInput& input);

/// The README's picture: relative error on z by method beside the height along the way, as one SVG file.
std::string render_overview_svg(const ReportInput& input);

}  // namespace isobar::report
