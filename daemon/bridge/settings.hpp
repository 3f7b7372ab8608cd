// SPDX-License-Identifier: BSD-3-Clause
// Settings of the bridge: the configuration file, overridden by the command line, completed by the
// environment.
#pragma once

#include <optional>
#include <string>

#include "config/config.hpp"
#include "daemon/bridge/environment.hpp"
#include "drivers/lidar/lidar_decoder.hpp"
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

/// Settings of the bridge, from the configuration, the command line and the environment.
struct Settings {
  bool is_base_station = false;
  bool receives_points = false;    ///< lidar.source is dds
  LidarLimits lidar_limits;        ///< of those clouds
  bool receives_pressure = false;  ///< barometer.source is dds
  bool receives_imu = false;       ///< imu.source is dds
  bool receives_wheel = false;     ///< wheel.source is dds
  dds::DdsConfig dds;              ///< frames with their prefix, domain_id >= 0
  dds::SensorMounts mounts;
  Environment environment;
  std::string values;  ///< all values that the bridge uses, as text: equal settings have equal texts
};

/// Adds description, version and options of the bridge to its command line; parsing fills `options`.
void add_options(CLI::App& app, Options& options);

/// Settings of a configuration.
/// @throws ConfigError when an option on the command line or the environment breaks a rule
[[nodiscard]] Settings settings_of(Config config, const Options& options);

/// Settings of the files, without any: of the defaults.
/// @throws ConfigErrors for every error of the files
/// @throws ConfigError when an option on the command line or the environment breaks a rule
[[nodiscard]] Settings load_settings(const Options& options);

}  // namespace isobar::bridge
