// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

#include "core/names.hpp"

namespace isobar {

std::string Setting::section() const {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? std::string() : key.substr(0, dot);
}

std::string Setting::name() const {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? key : key.substr(dot + 1);
}

const std::vector<std::string>& role_choices() {
  static const std::vector<std::string> names = kRoleNames.names();
  return names;
}

const std::vector<std::string>& method_choices() {
  static const std::vector<std::string> names = kMethodNames.names();
  return names;
}

const std::vector<std::string>& air_temperature_choices() {
  static const std::vector<std::string> names = kAirTemperatureModeNames.names();
  return names;
}

const std::vector<std::string>& compensation_choices() {
  static const std::vector<std::string> names = kCompensationModelNames.names();
  return names;
}

const std::vector<std::string>& matcher_choices() {
  static const std::vector<std::string> names = kMatcherNames.names();
  return names;
}

std::vector<Setting> settings_of(Config& config) {
  std::vector<Setting> settings;
  settings.push_back({.key = "role",
                      .target = &config.role,
                      .doc = "Role of this machine. robot: estimates its pose. base-station: stands still, "
                             "reads a barometer only and publishes its pressure for all robots.",
                      .choices = role_choices(),
                      .audience = Audience::kBasic});
  settings.push_back(
      {.key = "method",
       .target = &config.method,
       .doc = "How the pose is estimated. adaptive: all six degrees of freedom, with gravity, gyro, wheels "
              "and air "
              "pressure as information; finds the lidar's mount and the altimeter's bias. The paper's, for "
              "comparison: "
              "3dof: x, y and yaw, with height from air pressure. 4dof: z too. 6dof: all. 6dof-altitude, "
              "4dof-altitude: the height from air pressure only predicts z. odometry: no ICP.",
       .choices = method_choices(),
       .used_by = UsedBy::kRobot,
       .audience = Audience::kBasic,
       .apply = Apply::kStage});
  add_lidar_settings(config.lidar, settings);
  add_imu_settings(config.imu, settings);
  add_barometer_settings(config, settings);
  add_wheel_settings(config.wheel, settings);
  add_service_settings(config, settings);
  add_black_box_settings(config.black_box, settings);
  add_dds_settings(config.dds, settings);
  add_altimeter_settings(config.prior.altimeter, settings);
  add_motion_settings(config.prior, settings);
  add_height_settings(config.prior.height, settings);
  add_registration_settings(config.registration, settings);
  add_map_settings(config.map, config.map_files, settings);
  add_loop_settings(config.loops, settings);
  add_floor_settings(config.floors, settings);
  return settings;
}

}  // namespace isobar
