// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulation/deviations.hpp"

namespace CLI {
class App;
}

namespace isobar::tools {

/// Adds the options that ask for faults of a simulated run: --mount-error, --drift, --without …
/// Parsing throws UsageError "--option: "text": rule" for a value that breaks its form.
void add_deviation_options(CLI::App& command, simulation::Deviations& deviations);

}  // namespace isobar::tools
