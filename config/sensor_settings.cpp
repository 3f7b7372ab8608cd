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

std::vector<std::string> powers_of_two() { return {"1", "2", "4", "8", "16", "32", "64", "128"}; }

void add_dps310(dps310::Settings& dps310, std::vector<Setting>& settings) {
  const auto add_power = [&settings](const char* name, int& value, const char* unit, const char* doc) {
    settings.push_back({.key = std::string("barometer.dps310.") + name,
                        .target = &value,
                        .unit = unit,
                        .doc = doc,
                        .choices = powers_of_two()});
  };
  settings.push_back({.key = "barometer.dps310.bus",
                      .target = &dps310.bus,
                      .doc = "The kernel's I2C device. isobard needs the right to open it."});
  settings.push_back({.key = "barometer.dps310.address",
                      .target = &dps310.address,
                      .doc = "0x76 where SDO is tied to ground.",
                      .choices = {"0x77", "0x76"}});
  add_power(
      "pressure_rate_hz", dps310.pressure_rate_hz, "Hz",
      "Pressures a second. Rate times measurement time, of pressure and temperature together, must be below "
      "1 s; a measurement takes 3.6, 5.2, 8.4, 14.8, 27.6, 53.2, 104.4, 206.8 ms by oversampling.");
  add_power(
      "pressure_oversampling", dps310.pressure_oversampling, "",
      "Averages a pressure; noise 2.5, 1, 0.5, 0.4, 0.35, 0.3, 0.2, 0.2 Pa. 16 times is the most that 32 Hz "
      "allow.");
  add_power("temperature_rate_hz", dps310.temperature_rate_hz, "Hz",
            "Temperatures a second; the chip's own changes slowly.");
  add_power("temperature_oversampling", dps310.temperature_oversampling, "", "Averages a temperature.");
}

void add_iio_device(const std::string& section, iio::Settings& device, std::vector<Setting>& settings) {
  settings.push_back(
      {.key = section + ".folder",
       .target = &device.folder,
       .doc =
           "The device's folder. Numbers follow the order of discovery; the file name in each folder tells "
           "which is which."});
  settings.push_back({section + ".rate_hz", &device.rate_hz, "Hz", 1, 100,
                      "How often it is read. No faster than it converts: repeated values count as stuck."});
}

void add_setra278(iio::SetraSettings& setra, std::vector<Setting>& settings) {
  add_iio_device("barometer.setra278", setra.device, settings);
  settings.push_back({.key = "barometer.setra278.channel",
                      .target = &setra.channel,
                      .doc = "The converter's channel, as its files begin."});
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("barometer.setra278.") + name, &value, unit, lowest, highest, doc});
  };
  setra278::Span& span = setra.span;
  add("low_v", span.low_v, "V", -10.0, 10.0,
      "Lower end of the output; behind a divider, what the converter sees.");
  add("high_v", span.high_v, "V", -10.0, 10.0, "Upper end: 2.5 or 5 by order code.");
  add("low_pa", span.low_pa, "Pa", 10e3, 120e3, "Pressure at low_v: 60000, 50000 or 80000 by order code.");
  add("high_pa", span.high_pa, "Pa", 10e3, 120e3, "Pressure at high_v.");
}

void add_compensation_file(const std::string& section, std::string& file, std::vector<Setting>& settings) {
  settings.push_back({.key = section + ".compensation_file",
                      .target = &file,
                      .doc =
                          "File that `isobar calibrate` wrote for this sensor, beside this one or with its "
                          "whole path; empty: none."});
}

void add_barometer(BarometerSettings& barometer, std::vector<Setting>& settings) {
  settings.push_back({.key = "barometer.source",
                      .target = &barometer.source,
                      .doc =
                          "Where its samples come from. input: datagrams. dps310, setra278, iio: a sensor of "
                          "this machine, which isobard reads itself; datagrams of it are then refused.",
                      .choices = {"input", "dps310", "setra278", "iio"}});
  add_position("barometer", barometer.mount,
               "The pressure port in base_link: what a pitching robot lifts is taken out.", settings);
  settings.push_back(
      {"barometer.stuck_time_s", &barometer.stuck_time_s, "s", 0.0, 600.0,
       "A sensor of this machine whose value does not change by one bit for longer, and for 16 "
       "readings, is stuck. 0: never; for converters too coarse to see the air move."});
  add_compensation_file("barometer", barometer.compensation_file, settings);
  add_dps310(barometer.dps310, settings);
  add_setra278(barometer.setra278, settings);
  add_iio_device("barometer.iio", barometer.iio, settings);
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
  add_barometer(config.barometer, settings);
  add_compensation_settings("barometer.compensation", config.prior.compensation, settings);
  add_compensation_file("base_barometer", config.base_barometer.compensation_file, settings);
  add_compensation_settings("base_barometer.compensation", config.prior.base_compensation, settings);
}

}  // namespace isobar
