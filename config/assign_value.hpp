// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/setting.hpp"
#include "config/toml_place.hpp"

namespace isobar {

/// Writes a TOML value to the place that a setting names.
/// @throws ConfigError "file:line:column: key: rule (got VALUE)" when the type is wrong or the rule is broken
void assign_value(const Setting& setting, const TomlPlace& place);

}  // namespace isobar
