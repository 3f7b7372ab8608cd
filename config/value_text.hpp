// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "config/setting.hpp"

namespace isobar {

/// " within 0.1 … 10 m", or empty where a setting has no range.
std::string range_text(const Setting& setting);

/// The value of a setting as TOML.
std::string value_text(const Setting& setting);

/// Which rule a text breaks; nullptr when none.
const char* broken_text_rule(TextRule rule, const std::string& text);

/// Rules of a calibration as a whole. Throws ConfigError "PLACEkey: rule".
void check_compensation(const CompensationConfig& compensation, const std::string& place);

/// Rules that tie several settings together. Throws ConfigError "file: key: rule".
void check_together(const Config& config, const std::string& file);

}  // namespace isobar
