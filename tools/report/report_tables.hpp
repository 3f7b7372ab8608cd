// SPDX-License-Identifier: BSD-3-Clause
// The report's tables and words, as HTML.
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// What was compared with what, as plain text.
std::string run_summary(const evaluation::EvaluatedRun& run);

/// Every figure of every method; the best of each row in bold.
std::string figures_table(const evaluation::EvaluatedRun& run);

/// Height error of each floor; empty without flat segments.
std::string floors_table(const evaluation::EvaluatedRun& run);

/// How each figure is defined, with this run's options.
std::string definitions(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
