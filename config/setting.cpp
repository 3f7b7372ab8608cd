// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

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
    for (const CompensationModel model : kCompensationModels) list.emplace_back(model_name(model));
    return list;
  }();
  return names;
}

std::vector<Setting> settings_of(Config& config) {
  std::vector<Setting> settings;
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
  return settings;
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
      {"realtime", "Scheduling of the threads of a live run."},
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
