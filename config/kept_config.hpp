// SPDX-License-Identifier: BSD-3-Clause
// The last good configuration on the disk: with it a program starts while the configuration's files are bad.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "config/config.hpp"

namespace isobar {

/// Name of the kept configuration in the state folder of the service.
inline constexpr const char* kKeptConfigFile = "last-good.toml";

/// A configuration that was in force.
struct KeptConfig {
  Config config;
  std::int64_t since_s = 0;  ///< Unix time at which it was accepted
};

/// Name of a configuration for comparisons: the path of its main file, without links in its folder's name.
[[nodiscard]] std::string config_identity(const std::filesystem::path& main);

/// Writes a configuration whole, all values written out, with a checksum: whenever the program or the machine
/// ends, either the old or the new content is there.
/// @param main the file of which it is the configuration
/// @throws ServiceError naming the file when it cannot be written; the old content stays
void keep_config(const std::filesystem::path& file, const std::filesystem::path& main,
                 const KeptConfig& kept);

/// Reads what keep_config() has written.
/// @return nothing without such a file
/// @throws ConfigError "file: reason" for a file that is damaged, of others, of another `main`, or that breaks
/// a rule, as one of another version may
[[nodiscard]] std::optional<KeptConfig> read_kept_config(const std::filesystem::path& file,
                                                         const std::filesystem::path& main);

}  // namespace isobar
