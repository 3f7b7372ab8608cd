// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds_config.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "core/errors.hpp"

namespace isobar::dds {
namespace {

void require(bool holds, const char* key, const char* rule) {
  if (!holds) {
    throw ConfigError("dds." + std::string(key) + ": " + rule);
  }
}

bool is_within(double value, double lowest, double highest) {
  return std::isfinite(value) && value >= lowest && value <= highest;
}

bool consists_of_letters_digits(std::string_view text, std::string_view also) {
  return std::all_of(text.begin(), text.end(), [also](unsigned char c) {
    return std::isalnum(c) != 0 || also.find(static_cast<char>(c)) != std::string_view::npos;
  });
}

void require_name(const std::string& name, const char* key) {
  require(!name.empty() && name.size() <= 100 && consists_of_letters_digits(name, "_/"), key,
          "must be 1 to 100 letters, digits, '_' or '/'");
  require(name.front() != '/' && name.back() != '/', key, "must not start or end with '/'");
}

}  // namespace

void validate(const DdsConfig& config) {
  require(config.domain_id >= 0 && config.domain_id <= 232, "domain_id", "must be 0 to 232");
  require(
      consists_of_letters_digits(config.network_interface, "_.-:@") && config.network_interface.size() <= 64,
      "network_interface", "must be the name or the address of an interface");
  require(config.max_message_bytes >= 1472 && config.max_message_bytes <= 65500, "max_message_bytes",
          "must be 1472 to 65500");
  if (!config.ros_namespace.empty()) {
    require_name(config.ros_namespace, "ros_namespace");
  }
  require_name(config.node_name, "node_name");
  require(config.ros_gid_bytes == 16 || config.ros_gid_bytes == 24, "ros_gid_bytes", "must be 16 or 24");
  require_name(config.map_frame, "map_frame");
  require_name(config.odom_frame, "odom_frame");
  require_name(config.base_frame, "base_frame");
  require_name(config.lidar_frame, "lidar_frame");
  require_name(config.imu_frame, "imu_frame");
  require_name(config.barometer_frame, "barometer_frame");
  require_name(config.base_station, "base_station");
  if (!config.second_base_station.empty()) {
    require_name(config.second_base_station, "second_base_station");
    require(config.second_base_station != config.base_station, "second_base_station",
            "must differ from dds.base_station");
  }
  require(is_within(config.odom_rate_hz, 1.0, 1000.0), "odom_rate_hz", "must be 1 to 1000 Hz");
  require(is_within(config.altitude_rate_hz, 0.1, 200.0), "altitude_rate_hz", "must be 0.1 to 200 Hz");
  require(is_within(config.propagator.slew_time_s, 0.01, 10.0), "propagator.slew_time_s",
          "must be 0.01 to 10 s");
  require(is_within(config.propagator.max_slew_m_s, 1e-3, 100.0), "propagator.max_slew_m_s",
          "must be 0.001 to 100 m/s");
  require(is_within(config.propagator.max_slew_rad_s, 1e-3, 100.0), "propagator.max_slew_rad_s",
          "must be 0.001 to 100 rad/s");
  require(is_within(config.propagator.max_extrapolation_s, 0.0, 5.0), "propagator.max_extrapolation_s",
          "must be 0 to 5 s");
}

}  // namespace isobar::dds
