// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// Prints the main figures with their units, one method per row, the height error of each floor, and the
/// notes.
void print_table(std::FILE* out, const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
