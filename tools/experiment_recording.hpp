// SPDX-License-Identifier: BSD-3-Clause
// What `isobar experiment` and `isobar experiment all` share.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/estimates.hpp"
#include "simulation/simulate.hpp"

namespace isobar::tools {

/// Simulates into `recording`, unless a recording is there already. The folder appears when it is complete, so
/// that an interrupted simulation is not taken for a recording.
/// @return true if it was simulated
/// @throws what simulation::simulate() throws
bool simulate_if_missing(const simulation::ScenarioRequest& request, const std::filesystem::path& recording,
                         const std::function<void(double)>& progress);

/// Methods by name; all methods for no name.
/// @throws UsageError naming the option --methods and the unknown name
std::vector<Method> chosen_methods(const std::vector<std::string>& names);

}  // namespace isobar::tools
