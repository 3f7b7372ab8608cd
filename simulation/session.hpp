// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "simulation/scenario.hpp"

namespace isobar::simulation {

/// Makes another session of the same site: other weather, and furniture that was not there, beside the way. Building, way,
/// robot and base station stay.
void begin_another_session(Scenario& scenario, std::uint64_t session_seed);

}  // namespace isobar::simulation
