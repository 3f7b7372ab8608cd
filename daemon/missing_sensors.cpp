// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/missing_sensors.hpp"

namespace isobar {
namespace {

std::string without_barometer(bool imu) {
  return std::string("no barometer: the height is the lidar's, and an elevator is not seen") +
         (imu ? "; 3-DOF runs as 4-DOF" : "");
}

}  // namespace

PresentSensors present_sensors(const Config& config) {
  return {.imu = config.imu.present(),
          .wheels = config.wheel.present(),
          .barometer = config.barometer.present(),
          .base_station = config.input.expect_base_station};
}

std::vector<std::string> missing_sensor_texts(const PresentSensors& present) {
  std::vector<std::string> texts;
  if (!present.imu) {
    texts.emplace_back(
        "no IMU: every scan as 6-DOF, from the wheels or else the motion of the scans before; gravity is "
        "unknown: the first scan is level, and roll, pitch and height drift with the way");
  }
  if (!present.barometer) texts.push_back(without_barometer(present.imu));
  if (present.barometer && !present.base_station) {
    texts.emplace_back(
        "no base station: the height of the air is relative to the start and drifts with the weather");
  }
  if (!present.wheels) {
    texts.emplace_back("no wheels: constant velocity between scans; a long corridor may lose its way");
  }
  return texts;
}

}  // namespace isobar
