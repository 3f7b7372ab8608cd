// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "core/geometry.hpp"
#include "core/registration/pose_propagator.hpp"

namespace isobar::dds {

/// What isobar-dds says, to whom, and under which names. Section [dds] of the configuration.
struct DdsConfig {
  /// DDS domain, ROS_DOMAIN_ID of the nodes that listen (the ports of more do not exist).
  int domain_id = 0;
  /// Network interface to speak on, by name or address; empty: the best one of the machine, and loopback
  /// where there is no other.
  std::string network_interface;
  /// Largest datagram [bytes]. The default is Cyclone's own; 65500 halves the load of clouds
  /// where nobody minds IP fragments, as on loopback.
  int max_message_bytes = 14720;

  /// Put before the topics' names, such as "robot1"; empty: none. Never before /tf, /tf_static, /diagnostics.
  std::string ros_namespace;
  /// Under this name ROS 2 tools show the bridge.
  std::string node_name = "isobar";
  /// Bytes of an endpoint's id in ros_discovery_info: 16 from ROS 2 Iron on, 24 up to Humble.
  int ros_gid_bytes = 16;

  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  std::string lidar_frame = "lidar";
  std::string imu_frame = "imu";
  std::string barometer_frame = "barometer";

  /// Rate of odom and tf [Hz]; the IMU's rate if that is lower. 100 serves controllers.
  double odom_rate_hz = 100.0;
  /// Rate of altitude [Hz]. Air pressure is filtered to a few hertz anyway.
  double altitude_rate_hz = 10.0;
  /// Publish each registered scan and the map. Off saves most of the bridge's load.
  bool publish_clouds = true;

  /// Name of the base station, whose topics are NAME/fluid_pressure and NAME/temperature. A robot listens to
  /// it, a base station bears it.
  std::string base_station = "base";
  /// Name of a second base station that a robot listens to; empty: none.
  std::string second_base_station;
  /// Take the pressure of the base stations over DDS.
  bool receive_base_pressure = true;
  /// Take the robot's own sensors from imu/data and wheel/odom, for robots whose drivers are ROS 2 nodes.
  /// Off, because a sensor must not reach isobard in two ways.
  bool receive_sensors = false;
  /// How corrections of the registration enter odom.
  PosePropagatorConfig propagator;
};

/// Where the sensors sit in base_link, for /tf_static.
struct SensorMounts {
  Mount lidar;
  Mount imu;
  Mount barometer;
};

/// @throws ConfigError naming the key and the rule that it breaks
void validate(const DdsConfig& config);

}  // namespace isobar::dds
