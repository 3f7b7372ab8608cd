// SPDX-License-Identifier: BSD-3-Clause
// The report's tables and definitions, as HTML.
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// Number of estimates, reference, length and duration, as a plain sentence.
std::string run_summary(const evaluation::EvaluatedRun& run);

/// All figures of all methods, the best of each row in bold.
std::string figures_table(const evaluation::EvaluatedRun& run);

/// Height error of each floor; empty without flat segments.
std::string floors_table(const evaluation::EvaluatedRun& run);

/// Definition of each figure, with this run's options.
std::string definitions(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
