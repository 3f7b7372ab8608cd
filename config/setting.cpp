// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

#include <algorithm>
#include <array>

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
  static const std::vector<std::string> names{"robot", "base-station"};
  return names;
}

const std::vector<std::string>& method_choices() {
  static const std::vector<std::string> names{"6dof",          "4dof",          "3dof",
                                              "6dof-altitude", "4dof-altitude", "odometry"};
  return names;
}

const std::vector<std::string>& air_temperature_choices() {
  static const std::vector<std::string> names{"auto", "fixed"};
  return names;
}

const std::vector<std::string>& compensation_choices() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    list.reserve(kCompensationModels.size());
    for (const CompensationModel model : kCompensationModels) list.emplace_back(model_name(model));
    return list;
  }();
  return names;
}

const std::vector<std::string>& matcher_choices() {
  static const std::vector<std::string> names{"plane-hash", "nearest"};
  return names;
}

std::vector<Setting> settings_of(Config& config) {
  std::vector<Setting> settings;
  settings.push_back({.key = "role",
                      .target = &config.role,
                      .doc = "robot: estimates where it is. base-station: stands still, reads a barometer "
                             "only and tells all robots its pressure.",
                      .choices = role_choices()});
  settings.push_back(
      {.key = "method",
       .target = &config.method,
       .doc = "What the ICP estimates. 3dof: x, y and yaw, height from air pressure (the paper's "
              "method). 4dof: z too. 6dof: all. ...-altitude: height from pressure only predicts z. "
              "odometry: no ICP.",
       .choices = method_choices()});
  add_sensor_settings(config, settings);
  add_service_settings(config, settings);
  add_prior_settings(config.prior, settings);
  add_registration_settings(config.registration, settings);
  add_map_settings(config.map, settings);
  add_map_file_settings(config.map_files, settings);
  return settings;
}

bool is_for_robots_only(std::string_view key) {
  // What a base station needs of a section that it does not need.
  static constexpr std::array<std::string_view, 4> kForBoth{
      "altimeter.noise_floor_pa", "altimeter.noise_ceiling_pa", "altimeter.initial_noise_pa",
      "altimeter.stuck_timeout_s"};
  // Sections end with a dot.
  // clang-format off
  static constexpr std::array<std::string_view, 37> kForRobots{
      "method", "lidar.", "imu.", "barometer.xyz_m", "base_barometer.", "output.", "realtime.prior_priority",
      "realtime.lidar_priority", "realtime.registration_priority", "realtime.map_cpus",
      "realtime.lidar_deadline_ms", "realtime.prior_deadline_ms", "realtime.registration_deadline_ms",
      "realtime.map_deadline_ms", "realtime.prior_reach_ms", "realtime.prior_wait_ms",
      "dds.second_base_station", "dds.map_frame", "dds.odom_frame", "dds.base_frame", "dds.lidar_frame",
      "dds.imu_frame", "dds.barometer_frame", "dds.odom_rate_hz", "dds.altitude_rate_hz", "dds.publish_clouds",
      "dds.receive_base_pressure", "dds.receive_sensors", "dds.propagator.", "altimeter.", "attitude.",
      "standstill.", "dead_reckoning.", "height.", "limits.", "registration.", "map."};
  // clang-format on
  const auto names = [key](std::string_view entry) {
    return entry.ends_with('.') ? key.starts_with(entry) : key == entry;
  };
  return std::none_of(kForBoth.begin(), kForBoth.end(), names) &&
         std::any_of(kForRobots.begin(), kForRobots.end(), names);
}

std::string_view section_doc(std::string_view section) {
  struct Doc {
    std::string_view section;
    std::string_view doc;
  };
  static constexpr auto kDocs = std::to_array<Doc>({
      {"lidar", "The lidar, as a live run reads it from the network. A replay takes it from the recording."},
      {"imu", "Where the IMU sits on the robot. A replay takes it from the recording."},
      {"barometer", "The robot's barometer. A replay takes samples and mount from the recording."},
      {"barometer.dps310", "A DPS310 on an I2C bus of this machine; used where barometer.source is dps310."},
      {"barometer.setra278",
       "A Setra 278 behind a converter that the kernel reads (industrial I/O); used where "
       "barometer.source is setra278."},
      {"barometer.iio",
       "Any other barometer with a driver of the kernel; used where barometer.source is iio. Drivers that "
       "round, as the kernel's for the DPS310 does to 1 Pa, need a longer barometer.stuck_time_s."},
      {"barometer.compensation",
       "What `isobar calibrate` found about the robot's barometer: p_cal = sum of c_ij u^i v^j, "
       "u = (p - centre) / scale, v = (t - centre) / scale."},
      {"compensation",
       "What `isobar calibrate` found: p_cal = sum of c_ij u^i v^j, u = (p - centre) / scale, "
       "v = (t - centre) / scale."},
      {"base_barometer", "The base station's barometer, where it does not compensate its samples itself."},
      {"base_barometer.compensation", "The same for the first base station's barometer."},
      {"input", "UDP port on which a live run takes samples of IMU, barometers and wheels."},
      {"output", "What a live run writes and shows."},
      {"realtime", "Scheduling of the threads of a live run, and how late each stage may be."},
      {"dds", "What isobar-dds says, to whom, and under which names."},
      {"dds.propagator", "How corrections of the registration enter odom."},
      {"altimeter", "How air pressure is checked and turned into height."},
      {"altimeter.air",
       "Air temperature between base station and robot: 10 K wrong is 3.4 % of every height."},
      {"attitude", "Attitude and velocity from gyro, accelerometer and wheels."},
      {"standstill", "When nothing moves."},
      {"dead_reckoning", "Dead reckoning with wheels."},
      {"height", "Filter of the height from pressure, acceleration and wheels."},
      {"limits", "What arrives from the sensors is believed within these limits only."},
      {"registration", "How a scan is prepared, matched to the map and solved."},
      {"map", "Size and density of the local map, and when it changes."},
  });
  for (const Doc& entry : kDocs) {
    if (entry.section == section) {
      return entry.doc;
    }
  }
  return {};
}

}  // namespace isobar
