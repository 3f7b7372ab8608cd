// SPDX-License-Identifier: BSD-3-Clause
// The report: one HTML file that needs no network. Its script draws charts and map; without it figures and tables remain.
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

struct ReportInput {
  std::string title;        ///< the experiment, such as "Three floors, seed 1"
  std::string description;  ///< a sentence or two below the title; may be empty
  std::string command;      ///< the command line that makes this report; may be empty
  evaluation::EvaluatedRun run;
};

std::string render_report(const ReportInput& input);

}  // namespace isobar::report
