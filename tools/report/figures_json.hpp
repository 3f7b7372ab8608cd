// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// All figures as JSON: {"reference": …, "methods": [{"name": …, "z_rpe_median": …}]}; null when unknown.
/// Lengths in metres, angles in degrees, shares 0 … 1.
std::string figures_json(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
