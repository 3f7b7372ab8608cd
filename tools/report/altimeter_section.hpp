// SPDX-License-Identifier: BSD-3-Clause
// The part of the report about the altimeter's bias.
#pragma once

#include <string>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// HTML: bias of the altimeter against the map over time, its faults, the largest innovation; of the main method, else
/// of the first that estimates it. Empty where none does.
std::string altimeter_section(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
