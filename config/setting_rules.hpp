// SPDX-License-Identifier: BSD-3-Clause
// Rules of the values: of one setting, from the table, and of several together.
#pragma once

#include <functional>
#include <string>

#include "config/problems.hpp"
#include "config/setting.hpp"

namespace isobar {

/// " within 0.1 … 10 m"; empty for a setting without a range.
std::string range_text(const Setting& setting);

/// The rule of a setting's values, as errors state it: "must be a number within 0.1 … 10 m".
std::string rule_text(const Setting& setting);

/// Whether a number is finite and in the range of a setting.
bool is_in_range(const Setting& setting, double value);

/// Whether a text or a number, spelled as a text, is one of the choices of a setting.
bool is_choice(const Setting& setting, const std::string& value);

/// Whether a text obeys a rule.
bool keeps_rule(TextRule rule, const std::string& text);

/// Whether the current value of a setting obeys the setting's rule.
bool keeps_rule(const Setting& setting);

/// Checks a calibration as a whole.
/// @throws ConfigError "PLACEkey: rule" when it cannot be used
void check_compensation(const CompensationConfig& compensation, const std::string& place);

/// Place of a key in errors: "FILE:LINE:COLUMN", or the name of the source.
using PlaceOfKey = std::function<std::string(const std::string& key)>;

/// Checks the rules between settings, such as min_range_m < max_range_m; adds "place: key: rule" for each
/// broken one.
void check_together(const Config& config, const PlaceOfKey& place_of, Problems& problems);

}  // namespace isobar
