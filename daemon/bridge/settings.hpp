// SPDX-License-Identifier: BSD-3-Clause
// What the bridge is told: by its command line, which wins, and by the configuration file.
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

struct Settings {
  bool is_base_station = false;
  dds::DdsConfig dds;
  dds::SensorMounts mounts;
};

void add_options(CLI::App& app, Options& options);

/// @throws ConfigError the file or the command line breaks a rule
[[nodiscard]] Settings load_settings(const Options& options);

}  // namespace isobar::bridge
