// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ipc/inputs.hpp"

namespace isobar::web {

/// The settings that isobard has in force, and where each value comes from, as far as its files can be read here.
[[nodiscard]] nlohmann::ordered_json settings_in(const ipc::RunDescription& description);

}  // namespace isobar::web
