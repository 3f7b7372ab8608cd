// SPDX-License-Identifier: BSD-3-Clause
// The scenarios by name.
#pragma once

#include <cstdint>
#include <string>

#include "simulation/scenario.hpp"

namespace isobar::simulation {

struct ScenarioEntry {
  const char* name;
  const char* description;
  Scenario (*make)(std::uint64_t seed, bool short_form);
  bool is_long = false;  ///< as in ScenarioInfo
};

/// @throws UsageError naming all scenarios when there is none of this name
[[nodiscard]] const ScenarioEntry& find_scenario(const std::string& name);

}  // namespace isobar::simulation
