// SPDX-License-Identifier: BSD-3-Clause
#include "tools/config_proposal.hpp"

#include <cmath>

#include "config/end_mark.hpp"
#include "core/toml_text.hpp"

namespace isobar::tools {
namespace {

std::string comment(const std::string& text) { return "# " + text + "\n"; }

/// "a, b" or "none"
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

std::string hex_text(std::uint8_t value) {
  constexpr const char* kHexDigits = "0123456789abcdef";
  return std::string("0x") + kHexDigits[value / 16] + kHexDigits[value % 16];
}

std::string sentence(const FoundLidar& lidar) {
  const std::string name =
      lidar.model.empty() ? "a lidar without a driver (" + lidar.mismatch + ")" : lidar.model;
  return name + ": " + std::to_string(std::lround(lidar.packets_per_s)) + " packets a second from " +
         lidar.sender + " to UDP port " + std::to_string(lidar.port);
}

std::string lidar_lines(const Survey& survey) {
  std::string out = "\n";
  const FoundLidar* chosen = nullptr;
  for (const FoundLidar& lidar : survey.lidars) {
    out += comment("Found " + sentence(lidar) + ".");
    if (chosen == nullptr && !lidar.model.empty()) chosen = &lidar;
  }
  if (survey.lidars.empty()) out += comment("No lidar was heard; the model is a guess.");
  out += "lidar.model = " + quoted_toml(chosen != nullptr ? chosen->model : "VLP-16") + "\n";
  if (chosen != nullptr && survey.lidars.size() > 1) {
    out += "lidar.sender = " + quoted_toml(chosen->sender) + "\n";
  }
  out += "lidar.port = " + std::to_string(chosen != nullptr ? chosen->port : 2368) + "\n";
  out += comment("Origin [m] and roll, pitch, yaw [deg] of the sensors in base_link: measure them.");
  out += "lidar.xyz_m = [0.0, 0.0, 0.0]\nlidar.rpy_deg = [0.0, 0.0, 0.0]\nimu.xyz_m = [0.0, 0.0, 0.0]\n";
  return out +
         comment("datagram: its samples come by UDP; dds: from a ROS 2 topic; none: this robot has no IMU.") +
         "imu.source = \"datagram\"\n";
}

std::string barometer_lines(const Survey& survey) {
  std::string out = "\n";
  const FoundI2c* dps310 = nullptr;
  for (const FoundI2c& device : survey.i2c) {
    out += comment("Found " + std::string(device.is_dps310 ? "a DPS310" : "a device that is no DPS310") +
                   " at " + device.bus + ", address " + hex_text(device.address) + ".");
    if (dps310 == nullptr && device.is_dps310) dps310 = &device;
  }
  for (const FoundIio& device : survey.iio) {
    out += comment("Found " + device.name + " with a kernel driver in " + device.folder + ".");
  }
  if (dps310 != nullptr) {
    return out + "barometer.source = \"dps310\"\nbarometer.dps310.bus = " + quoted_toml(dps310->bus) +
           "\nbarometer.dps310.address = " + quoted_toml(hex_text(dps310->address)) + "\n";
  }
  if (!survey.iio.empty()) {
    return out +
           "barometer.source = \"iio\"\nbarometer.iio.folder = " + quoted_toml(survey.iio.front().folder) +
           "\n";
  }
  out += comment("No barometer was found (I2C buses: " + listed(survey.i2c_buses) +
                 "); its samples are expected as datagrams. Without a barometer: none.");
  return out + "barometer.source = \"datagram\"\n";
}

}  // namespace

std::string proposal(const Survey& survey) {
  std::string out =
      comment("Proposed by `isobar config init` from what this machine has. All other settings:");
  out += comment("`isobar config show`. Check: `isobar config check FILE`.");
  out += "role = \"robot\"\n" + lidar_lines(survey) + barometer_lines(survey);
  out += "\n" + comment("Trajectory and map. Empty: no files are written.");
  out += "output.directory = \"/var/lib/isobar/run\"\n\n";
  out += comment(
      "IMU and wheels come as datagrams to UDP port 7373; from ROS 2 topics with imu.source and wheel.source "
      "\"dds\".");
  out += comment("Serial lines: " + listed(survey.serial) + ". GPIO chips: " + listed(survey.gpio) + ".");
  for (const std::string& note : survey.notes) out += comment("Not looked at: " + note);
  return with_end_mark(out);
}

}  // namespace isobar::tools
