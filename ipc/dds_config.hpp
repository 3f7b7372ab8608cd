// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "core/geometry.hpp"
#include "core/registration/pose_propagator.hpp"

namespace isobar::dds {

/// DDS network, topics and frames of isobar-dds: section [dds] of the configuration. Ranges and reasons stand
/// in the settings table (config/dds_settings.cpp).
struct DdsConfig {
  /// DDS domain: ROS_DOMAIN_ID of the nodes that listen.
  int domain_id = 0;
  /// Network interface, by name or address; empty: the best one, or loopback if there is no other.
  std::string network_interface;
  /// Largest datagram [bytes]. The default is Cyclone's.
  int max_message_bytes = 14720;

  /// ROS namespace in front of the topic names, such as "robot1"; empty: none. Never in front of /tf,
  /// /tf_static and /diagnostics.
  std::string ros_namespace;
  /// Node name of isobar-dds in ROS 2 tools.
  std::string node_name = "isobar";
  /// Bytes of an endpoint's id in ros_discovery_info: 16 from ROS 2 Iron on, 24 up to Humble.
  int ros_gid_bytes = 16;

  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  std::string lidar_frame = "lidar";
  std::string imu_frame = "imu";
  std::string barometer_frame = "barometer";

  /// Publishing rate of odom and tf [Hz]; the IMU's rate if that is lower.
  double odom_rate_hz = 100.0;
  /// Publishing rate of altitude [Hz].
  double altitude_rate_hz = 10.0;
  /// Publish the registered scans and the map as clouds.
  bool publish_clouds = true;

  /// Name of the base station, whose topics are NAME/fluid_pressure and NAME/temperature: the one a robot
  /// listens to, or a base station's own.
  std::string base_station = "base";
  /// Name of a second base station that a robot listens to; empty: none.
  std::string second_base_station;
  /// Receive the base stations' pressure over DDS.
  bool receive_base_pressure = true;
  /// Receive the robot's own sensors from imu/data and wheel/odom, for robots whose drivers are ROS 2 nodes.
  bool receive_sensors = false;
  /// Smoothing of the registration's corrections in the odom frame.
  PosePropagatorConfig propagator;
};

/// Mounts of the sensors in base_link, for /tf_static.
struct SensorMounts {
  Mount lidar;
  Mount imu;
  Mount barometer;
};

}  // namespace isobar::dds
