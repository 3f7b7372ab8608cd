// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "config/config.hpp"
#include "config/config_layer.hpp"

namespace isobar {

/// Reads a TOML file and the folder conf.d beside it over the defaults (config_layer.hpp).
/// @throws ConfigErrors "file:line:column: key: rule (got VALUE)" when a key is unknown or not used in the
/// role that the file names, or a value has the wrong type or breaks its rule; "file: reason" when the file
/// is missing, no regular file, too large, cut or no TOML
Config load_config(const std::filesystem::path& file);

/// Reads the text of a TOML file; `file` is its name in errors.
/// @throws ConfigError as load_config() does
Config parse_config(std::string_view text, const std::string& file);

/// Checks a configuration that was changed after loading, against the settings table.
/// @throws ConfigError "source: key: rule (got VALUE)" when a value breaks its rule
void check_config(const Config& config, const std::string& source);

/// Which settings are printed.
enum class Shown : std::uint8_t { kAll, kBasic };

/// The settings that config.role uses as TOML, the basic ones first, with unit, range and reason as comments.
/// Loading the text gives the same Config (of kBasic: the same basic settings).
std::string show_config(const Config& config, Shown shown = Shown::kAll);

/// The same with the file and line from which each value comes, and the hash of the configuration.
std::string show_config(const LoadedConfig& loaded, Shown shown = Shown::kAll);

/// The settings of show_config() without comments and marks, one a line.
std::string settings_in_force(const Config& config);

/// Reads a calibration that show_compensation() has printed.
/// @throws ConfigError as load_config() does
CompensationConfig load_compensation(const std::filesystem::path& file);

/// A calibration as TOML: `comment`, then the section [compensation] with a comment for each key.
std::string show_compensation(const CompensationConfig& compensation, const std::string& comment);

}  // namespace isobar
