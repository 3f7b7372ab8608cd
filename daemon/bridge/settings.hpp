// SPDX-License-Identifier: BSD-3-Clause
// Settings of the bridge: the configuration file, overridden by the command line.
#pragma once

#include <optional>
#include <string>

#include "ipc/dds_config.hpp"

namespace CLI {
class App;
}

namespace isobar::bridge {

/// The command line.
struct Options {
  std::string config_file;  ///< empty: defaults
  std::optional<int> domain;
  std::optional<std::string> network_interface;
};

/// Settings of the bridge, from the configuration and the command line.
struct Settings {
  bool is_base_station = false;
  dds::DdsConfig dds;
  dds::SensorMounts mounts;
};

/// Adds description, version and options of the bridge to its command line; parsing fills `options`.
void add_options(CLI::App& app, Options& options);

/// @throws ConfigError when the file or an option on the command line breaks a rule
[[nodiscard]] Settings load_settings(const Options& options);

}  // namespace isobar::bridge
