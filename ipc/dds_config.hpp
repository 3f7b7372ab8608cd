// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/geometry.hpp"
#include "core/name_table.hpp"
#include "core/registration/pose_propagator.hpp"

namespace isobar::dds {

/// ROS names of the topics, without leading slash and namespace: section [dds.topics]. Those of a base station
/// follow its name.
struct TopicNames {
  std::string odom = "odom";
  std::string pose = "pose";
  std::string altitude = "altitude";
  std::string tf = "tf";
  std::string tf_static = "tf_static";
  std::string registered_scan = "registered_scan";
  std::string map_cloud = "map_cloud";
  std::string map = "map";
  std::string floor = "floor";
  std::string floor_name = "floor_name";
  std::string diagnostics = "diagnostics";
  std::string points = "points";
  std::string pressure = "fluid_pressure";
  std::string imu = "imu/data";
  std::string wheel = "wheel/odom";
  std::string initial_pose = "initialpose";
  std::string base_pressure = "fluid_pressure";
  std::string base_temperature = "temperature";
};

/// Reliability that a reader asks of its writers.
enum class Reliability : std::uint8_t {
  kBestEffort,  ///< matches every writer
  kReliable,    ///< lost messages are sent again; does not match a best-effort writer
};

inline constexpr NameTable<Reliability, 2> kReliabilityNames{{{
    {Reliability::kBestEffort, "best_effort"},
    {Reliability::kReliable, "reliable"},
}}};

/// Quality of service of one input.
struct InputQos {
  Reliability reliability = Reliability::kBestEffort;
  int depth = 5;  ///< messages that wait for the reader, >= 1; a newer one drops the oldest
};

/// Quality of service of the inputs: section [dds.qos].
struct InputsQos {
  InputQos points;
  InputQos pressure;
  InputQos imu{.depth = 50};
  InputQos wheel{.depth = 10};
  InputQos initial_pose{.reliability = Reliability::kReliable};
  InputQos base_pressure;  ///< also of the base stations' temperature
};

/// DDS network, topics and frames of isobar-dds: section [dds] of the configuration. Ranges and reasons stand
/// in the settings table (config/dds_settings.cpp).
struct DdsConfig {
  /// DDS domain: ROS_DOMAIN_ID of the nodes that listen. -1: that of the environment, or 0.
  int domain_id = -1;
  /// Network interfaces beside loopback, by name or address, separated by commas; empty: all; "lo": loopback
  /// alone.
  std::string network_interface;
  /// IPv4 addresses of machines that multicast does not reach, separated by commas.
  std::string peers;
  /// Largest datagram [bytes]. The default is Cyclone's.
  int max_message_bytes = 14720;

  /// ROS namespace in front of the topic names, such as "robot1"; empty: none. Never in front of /tf,
  /// /tf_static and /diagnostics.
  std::string ros_namespace;
  /// Node name of isobar-dds in ROS 2 tools.
  std::string node_name = "isobar";
  /// Bytes of an endpoint's id in ros_discovery_info: 16 from ROS 2 Iron on, 24 up to Humble.
  int ros_gid_bytes = 16;

  TopicNames topics;
  InputsQos input_qos;

  /// In front of every frame name, such as "robot1/"; empty: none.
  std::string frame_prefix;
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  /// Frame on the ground under base_frame, parent of base_frame in /tf; empty: there is none.
  std::string footprint_frame;
  /// Height of base_frame above the ground on level ground [m], >= 0.
  double footprint_depth_m = 0.0;
  std::string lidar_frame = "lidar";
  std::string imu_frame = "imu";
  std::string barometer_frame = "barometer";

  /// Publishing rate of odom and tf [Hz]; the IMU's rate if that is lower.
  double odom_rate_hz = 100.0;
  /// Publishing rate of altitude [Hz].
  double altitude_rate_hz = 10.0;
  /// Publish the registered scans and the map as clouds.
  bool publish_clouds = true;
  bool receive_initial_pose = true;  ///< hints of where the robot is, such as RViz's
  bool publish_tf_map_odom = true;   ///< in /tf
  bool publish_tf_odom_base = true;  ///< in /tf
  bool publish_tf_static = true;     ///< the mounts of the sensors

  /// Name of the base station, whose topics are NAME/fluid_pressure and NAME/temperature: the one a robot
  /// listens to, or a base station's own.
  std::string base_station = "base";
  /// Name of a second base station that a robot listens to; empty: none.
  std::string second_base_station;
  /// Folder with the keys of this machine (ipc/keys); empty: base-station pressure is neither signed nor checked.
  std::string keys_directory;
  /// Receive the base stations' pressure over DDS.
  bool receive_base_pressure = true;
  /// Message type of the wheels' topic: "odometry", nav_msgs/Odometry; "twist",
  /// geometry_msgs/TwistWithCovarianceStamped.
  std::string wheel_type = "odometry";
  /// Use the orientation of the IMU's messages, where they hold one.
  bool imu_orientation = true;
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
