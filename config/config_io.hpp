// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/config.hpp"

namespace isobar {

/// Reads a TOML file over the defaults. Throws ConfigError "file:line:column: key: rule (got X)" for a key
/// that is unknown, a value of the wrong type or out of range, and for a file that is missing, a directory or
/// no TOML. The same for a key that means nothing in the role that the file names.
Config load_config(const std::filesystem::path& file);

/// The same from the text of a file; `file` is its name in errors.
Config parse_config(std::string_view text, const std::string& file);

/// Every setting that means something in config.role as TOML, with unit, range and reason as comments;
/// loading it gives the same Config.
std::string show_config(const Config& config);

/// Reads what show_compensation() gave, as `isobar calibrate` writes it. Throws ConfigError like
/// load_config().
CompensationConfig load_compensation(const std::filesystem::path& file);

/// A calibration as TOML, a section [compensation] with a comment for each key, below `comment`.
std::string show_compensation(const CompensationConfig& compensation, const std::string& comment);

}  // namespace isobar
