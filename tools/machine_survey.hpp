// SPDX-License-Identifier: BSD-3-Clause
// What a machine has: buses, devices and senders that a configuration can name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::tools {

/// A barometer on an I2C bus.
struct FoundI2c {
  std::string bus;  ///< "/dev/i2c-1"
  std::uint8_t address = 0;
  bool is_dps310 = false;  ///< its product id says so
};

/// A barometer with a kernel driver.
struct FoundIio {
  std::string folder;
  std::string name;  ///< "bmp280"
};

/// A lidar that sends.
struct FoundLidar {
  std::string sender;  ///< IPv4 address
  std::uint16_t port = 0;
  std::string model;     ///< "VLP-16"; empty: none with a driver
  std::string mismatch;  ///< what its packets say, where no model fits
  double packets_per_s = 0.0;
};

struct Survey {
  std::vector<std::string> i2c_buses;
  std::vector<FoundI2c> i2c;
  std::vector<FoundIio> iio;
  std::vector<std::string> serial;
  std::vector<std::string> gpio;
  std::vector<FoundLidar> lidars;
  std::vector<std::string> notes;  ///< what could not be looked at, with the reason
};

/// Looks at the devices below `root` ("/" but for tests): reads sysfs, and one register of each address at
/// which a known barometer may be.
void survey_devices(const std::filesystem::path& root, Survey& survey);

/// Listens to the ports of lidars.
/// @param seconds time of listening
void survey_lidars(double seconds, Survey& survey);

}  // namespace isobar::tools
