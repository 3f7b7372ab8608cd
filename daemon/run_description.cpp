// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_description.hpp"

#include <string_view>

#include "config/config_io.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {

recording::Manifest manifest_of(const Config& config) {
  recording::Manifest manifest = recording::Manifest::with_all_sensors();
  manifest.lidar->model = config.lidar.model;
  manifest.lidar->port = config.lidar.port;
  manifest.lidar->mount = config.lidar.mount;
  manifest.imu->mount = config.imu.mount;
  manifest.barometer->mount = config.barometer.mount;
  manifest.base_barometer->robot_clock = true;
  manifest.reference.reset();
  if (config.role == Role::kBaseStation) {
    manifest.lidar.reset();
    manifest.imu.reset();
    manifest.wheel.reset();
  }
  return manifest;
}

std::string settings_in_force(const Config& config) {
  const std::string shown = show_config(config);
  std::string settings;
  std::string_view rest = shown;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
    if (rest.front() != '#' && rest.front() != '\n') settings += rest.substr(0, end);
    rest.remove_prefix(end);
  }
  return settings;
}

RunDescriptionPublisher::RunDescriptionPublisher(const Config& config)
    : publisher_(ipc::topics::kRunDescription) {
  publish(config);
}

void RunDescriptionPublisher::publish(const Config& config) {
  ipc::RunDescription* message = publisher_.loan();
  if (message == nullptr) return;
  const std::string manifest = recording::manifest_text(manifest_of(config));
  const std::string settings = settings_in_force(config);
  const bool fits = manifest.size() + settings.size() <= ipc::RunDescription::kMaxBytes;
  message->robot_clock_offset_ns = RobotClock::offset_ns();
  manifest.copy(message->text, manifest.size());
  message->manifest_bytes = static_cast<std::uint32_t>(manifest.size());
  message->settings_bytes = fits ? static_cast<std::uint32_t>(settings.size()) : 0;
  if (fits) settings.copy(message->text + manifest.size(), settings.size());
  publisher_.publish(message);
}

}  // namespace isobar
