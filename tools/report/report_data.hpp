// SPDX-License-Identifier: BSD-3-Clause
// The data of a report's moving parts, as tools/web/page/src/report_data.ts reads them.
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// Heights, errors and ways of every method along the way, as JSON.
std::string report_data_json(const evaluation::EvaluatedRun& run);

/// The report's moving parts as HTML: data, maps, style and script. They take the place of what `fallback` shows, which
/// stays for a reader without scripts. `fallback` alone where the program was built without npm.
std::string live_parts(const evaluation::EvaluatedRun& run, const std::string& fallback);

}  // namespace isobar::report
