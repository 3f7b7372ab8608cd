// SPDX-License-Identifier: BSD-3-Clause
// A configuration as the sum of its files: isobar.toml, then conf.d/*.toml beside it in the order of names.
// What a later file sets replaces what an earlier one has set.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "config/config.hpp"

namespace isobar {

/// Folder beside the configuration file whose *.toml files are read after it.
inline constexpr const char* kConfigFolder = "conf.d";
/// The configuration of an installed machine.
inline constexpr const char* kInstalledConfig = "/etc/isobar/isobar.toml";

/// One file of a configuration.
struct ConfigLayer {
  std::string file;  ///< name in errors
  std::string text;
};

/// Where a key was set.
struct KeyOrigin {
  std::string file;
  std::uint32_t line = 0;
  std::string place;  ///< "FILE:LINE:COLUMN"
};
using KeyOrigins = std::map<std::string, KeyOrigin>;  ///< by key, "lidar.port"

/// A configuration, and what it was made of.
struct LoadedConfig {
  Config config;
  KeyOrigins origins;              ///< of the keys that a file sets; the others have their defaults
  std::vector<std::string> files;  ///< in the order of reading
  std::vector<std::string> notes;  ///< what may be a mistake, one sentence each
};

/// The files of a configuration in the order of reading: `main` first.
std::vector<std::filesystem::path> config_files(const std::filesystem::path& main);

/// Reads a configuration file and the folder conf.d beside it.
/// @throws ConfigErrors with every error of every file: "file:line:column: key: rule (got VALUE)", or
/// "file: reason" for a file that is missing, no regular file, too large, outside of the folder of `main`
/// by a link, cut (end_mark.hpp) or no TOML
LoadedConfig load_layers(const std::filesystem::path& main);

/// Loads files that are read already; relative names inside them start at the folder of their names.
/// @throws ConfigErrors as load_layers() does
LoadedConfig parse_layers(const std::vector<ConfigLayer>& layers);

/// Short checksum of all values: equal for configurations with equal values, whatever files they came from.
std::string config_hash(const Config& config);

}  // namespace isobar
