// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/settings.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "config/config_io.hpp"
#include "config/setting.hpp"
#include "config/value_text.hpp"
#include "core/version.hpp"

namespace isobar::bridge {

namespace {

/// Keys and values of the settings that the bridge uses: [dds], the role, the sensors' sources and mounts.
std::string used_values(Config config) {
  std::string text;
  for (const Setting& setting : settings_of(config)) {
    const std::string name = setting.name();
    if (setting.key.starts_with("dds.") || setting.key.starts_with("lidar.") || name == "role" ||
        name == "source" || name == "xyz_m" || name == "rpy_deg") {
      text += setting.key + " = " + value_text(setting) + "\n";
    }
  }
  return text;
}

}  // namespace

void add_options(CLI::App& app, Options& options) {
  app.name("isobar-dds");
  app.description(
      "isobar-dds: publishes isobard's estimates over DDS, as a ROS 2 node.\n"
      "Exit codes: 0 stopped by a signal, 64 usage, 69 service unavailable, 78 bad configuration.");
  app.set_version_flag("--version", version_line("isobar-dds"));
  app.add_option(
         "--config", options.config_file,
         "configuration file of isobard, of which the bridge uses section [dds], role and sensor mounts")
      ->type_name("FILE");
  app.add_option("--domain", options.domain,
                 "DDS domain, the ROS_DOMAIN_ID of the ROS 2 nodes (0 to 232; default: ROS_DOMAIN_ID here)")
      ->type_name("N");
  app.add_option("--interface", options.network_interface,
                 "network interfaces beside loopback, by name or address, separated by commas; lo: none")
      ->type_name("NAMES");
}

Settings load_settings(const Options& options) {
  return settings_of(options.config_file.empty() ? Config{} : load_config(options.config_file), options);
}

Settings settings_of(Config config, const Options& options) {
  if (options.domain) {
    config.dds.domain_id = *options.domain;
  }
  if (options.network_interface) {
    config.dds.network_interface = *options.network_interface;
  }
  check_config(config, "command line");
  Settings settings;
  settings.values = used_values(config);
  settings.is_base_station = config.role == Role::kBaseStation;
  settings.receives_points = !settings.is_base_station && config.lidar.source == LidarSource::kDds;
  settings.lidar_limits = {config.lidar.min_range_m, config.lidar.max_range_m, config.lidar.mask_start_deg,
                           config.lidar.mask_end_deg};
  settings.receives_pressure = !settings.is_base_station && config.barometer.source == BarometerSource::kDds;
  settings.receives_imu = !settings.is_base_station && config.imu.source == ImuSource::kDds;
  settings.receives_wheel = !settings.is_base_station && config.wheel.source == WheelSource::kDds;
  settings.dds = config.dds;
  if (settings.is_base_station && config.dds.node_name == dds::DdsConfig{}.node_name) {
    settings.dds.node_name += "_" + config.dds.base_station;
    std::replace(settings.dds.node_name.begin(), settings.dds.node_name.end(), '/', '_');
  }
  for (std::string* frame :
       {&settings.dds.map_frame, &settings.dds.odom_frame, &settings.dds.base_frame,
        &settings.dds.lidar_frame, &settings.dds.imu_frame, &settings.dds.barometer_frame}) {
    *frame = config.dds.frame_prefix + *frame;
  }
  std::string& footprint = settings.dds.footprint_frame;
  if (!footprint.empty()) footprint = config.dds.frame_prefix + footprint;
  settings.environment = apply_environment(settings.dds, &read_environment);
  settings.mounts = {config.lidar.mount, config.imu.mount, config.barometer.mount};
  return settings;
}

}  // namespace isobar::bridge
