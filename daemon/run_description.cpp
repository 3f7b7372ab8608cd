// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_description.hpp"

#include <filesystem>
#include <string>
#include <utility>

#include "config/config_io.hpp"
#include "daemon/stage_settings.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {

recording::Manifest manifest_of(const Config& config) {
  recording::Manifest manifest = recording::Manifest::with_all_sensors();
  manifest.lidar->model = config.lidar.model;
  manifest.lidar->port = config.lidar.port;
  manifest.lidar->info_port = info_port_of(config.lidar);
  manifest.lidar->mount = config.lidar.mount;
  if (!config.lidar.calibration_file.empty()) {
    manifest.lidar->calibration_file = std::filesystem::absolute(config.lidar.calibration_file).string();
  }
  if (config.lidar.source == LidarSource::kDds) {
    manifest.lidar->model = recording::kCloudModel;
    manifest.lidar->file = "lidar.clouds";
    manifest.lidar->info_port = 0;
    manifest.lidar->calibration_file.clear();
  }
  manifest.imu->mount = imu_mount(config);
  manifest.barometer->mount = config.barometer.mount;
  manifest.base_barometer->robot_clock = true;
  manifest.reference.reset();
  if (!config.imu.present()) manifest.imu.reset();
  if (!config.barometer.present()) manifest.barometer.reset();
  if (config.role == Role::kBaseStation) {
    manifest.lidar.reset();
    manifest.imu.reset();
    manifest.wheel.reset();
  }
  return manifest;
}

RunDescriptionPublisher::RunDescriptionPublisher(const Config& config, std::string configuration)
    : configuration_(std::move(configuration)), publisher_(ipc::topics::kRunDescription) {
  publish(config);
}

void RunDescriptionPublisher::publish(const Config& config) {
  ipc::RunDescription* message = publisher_.loan();
  if (message == nullptr) return;
  const std::string manifest = recording::manifest_text(manifest_of(config));
  const std::string settings = settings_in_force(config);
  const bool fits = manifest.size() + settings.size() <= ipc::RunDescription::kMaxBytes;
  ipc::copy_to_field(configuration_, message->configuration);
  message->robot_clock_offset_ns = RobotClock::offset_ns();
  manifest.copy(message->text, manifest.size());
  message->manifest_bytes = static_cast<std::uint32_t>(manifest.size());
  message->settings_bytes = fits ? static_cast<std::uint32_t>(settings.size()) : 0;
  if (fits) settings.copy(message->text + manifest.size(), settings.size());
  publisher_.publish(message);
}

}  // namespace isobar
