// SPDX-License-Identifier: BSD-3-Clause
// The curves along the way and the map of a report, as tools/web/page/src/report_data.ts reads them.
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// Heights, errors and ways of every method along the way, and the altimeter's heights, as JSON.
std::string report_data_json(const evaluation::EvaluatedRun& run);

/// Curves along the way and the map, as HTML for a page with PageScript::kReport. Only a sentence where the program was
/// built without npm.
std::string way_and_map(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
