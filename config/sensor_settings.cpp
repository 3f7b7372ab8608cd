// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

namespace isobar {
namespace {

constexpr double kMaxLeverM = 100.0;

void add_position(const std::string& section, Mount& mount, const char* doc, std::vector<Setting>& settings) {
  settings.push_back({section + ".xyz_m", &mount.xyz_m, "m", -kMaxLeverM, kMaxLeverM, doc});
}

void add_rotation(const std::string& section, Mount& mount, std::vector<Setting>& settings) {
  settings.push_back({section + ".rpy_deg", &mount.rpy_deg, "deg", -360.0, 360.0,
                      "Roll, pitch and yaw of the sensor in base_link, about its fixed axes x, y, z."});
}

}  // namespace

void add_sensor_settings(Config& config, std::vector<Setting>& settings) {
  LidarSettings& lidar = config.lidar;
  settings.push_back({.key = "lidar.model",
                      .target = &lidar.model,
                      .doc = "Packets of any other model are refused.",
                      .choices = {"VLP-16", "HDL-32E"}});
  settings.push_back({.key = "lidar.address",
                      .target = &lidar.address,
                      .doc = "IPv4 address to listen on; 0.0.0.0 is every interface.",
                      .text_rule = TextRule::kIpv4});
  settings.push_back({"lidar.port", &lidar.port, "", 1, 65'535,
                      "UDP port of the data packets; the factory setting is 2368."});
  add_position("lidar", lidar.mount, "Origin of the sensor in base_link.", settings);
  add_rotation("lidar", lidar.mount, settings);
  settings.push_back({"lidar.min_range_m", &lidar.min_range_m, "m", 0.0, 10.0,
                      "Nearer returns are dropped by the driver: housing and mount. 0 keeps all."});
  settings.push_back({"lidar.max_range_m", &lidar.max_range_m, "m", 1.0, 131.0,
                      "Farther returns are dropped by the driver. 131 keeps all."});
  settings.push_back(
      {"lidar.mask_start_deg", &lidar.mask_start_deg, "deg", 0.0, 360.0,
       "Sector in which the sensor sees the robot itself, from start to end, clockwise from above, 0 in "
       "front; it may pass 0. Equal values drop nothing."});
  settings.push_back({"lidar.mask_end_deg", &lidar.mask_end_deg, "deg", 0.0, 360.0, "End of that sector."});

  add_position("imu", config.imu.mount, "Origin of the IMU in base_link.", settings);
  add_rotation("imu", config.imu.mount, settings);
  add_position("barometer", config.barometer.mount,
               "The pressure port in base_link: what a pitching robot lifts is taken out.", settings);
  const auto add_file = [&settings](const char* key, std::string& file) {
    settings.push_back({.key = key,
                        .target = &file,
                        .doc =
                            "File that `isobar calibrate` wrote for this sensor, beside this one or with its "
                            "whole path; empty: none."});
  };
  add_file("barometer.compensation_file", config.barometer.compensation_file);
  add_compensation_settings("barometer.compensation", config.prior.compensation, settings);
  add_file("base_barometer.compensation_file", config.base_barometer.compensation_file);
  add_compensation_settings("base_barometer.compensation", config.prior.base_compensation, settings);
}

}  // namespace isobar
