// SPDX-License-Identifier: BSD-3-Clause
// ROS messages that become samples. A reader returns nullptr, or the rule that the bytes break, a static text: what it has
// filled then means nothing. Units are those of the message; whether the sender kept to them is not judged here.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/import/message_cursor.hpp"
#include "run/recording/cloud_file.hpp"

namespace isobar::imports {

struct MessageHeader {
  std::int64_t stamp_ns = 0;
  std::string frame_id;
};

/// A pose of `child` in the frame of the header.
struct StampedPose {
  MessageHeader header;
  std::string child;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

struct OdometryMessage {
  StampedPose pose;
  WheelSample twist;  ///< of `child` in `child`
};

struct CloudMessage {
  MessageHeader header;
  recording::CloudRecord cloud;
};

/// A datagram of a sensor in a message.
struct PacketOfMessage {
  std::int64_t stamp_ns = 0;  ///< of its receipt; 0: the message says none
  std::vector<std::uint8_t> bytes;
};
struct PacketsMessage {
  MessageHeader header;
  std::vector<PacketOfMessage> packets;
};

/// sensor_msgs/Imu.
const char* read_imu(MessageCursor cursor, MessageHeader& header, ImuSample& sample);
/// sensor_msgs/FluidPressure: the value as it is, and its variance.
const char* read_pressure(MessageCursor cursor, MessageHeader& header, PressureSample& sample);
/// sensor_msgs/Temperature [degrees C].
const char* read_temperature(MessageCursor cursor, MessageHeader& header, double& temperature_c);
/// nav_msgs/Odometry.
const char* read_odometry(MessageCursor cursor, OdometryMessage& message);
/// geometry_msgs/TwistStamped.
const char* read_twist(MessageCursor cursor, MessageHeader& header, WheelSample& sample);
/// geometry_msgs/PoseStamped and PoseWithCovarianceStamped.
const char* read_pose(MessageCursor cursor, StampedPose& pose);
/// geometry_msgs/TransformStamped.
const char* read_transform(MessageCursor& cursor, StampedPose& pose);
/// tf2_msgs/TFMessage, tf/tfMessage.
const char* read_transforms(MessageCursor cursor, std::vector<StampedPose>& poses);
/// sensor_msgs/PointCloud2.
const char* read_cloud(MessageCursor cursor, CloudMessage& message);
/// livox_ros_driver(2)/CustomMsg, as a cloud with the fields x, y, z, intensity, line and offset_time [ns].
const char* read_livox(MessageCursor cursor, CloudMessage& message);
/// std_msgs/String.
const char* read_string(MessageCursor cursor, std::string& text);

/// Messages that carry datagrams of a lidar: velodyne_msgs/VelodyneScan, pandar_msgs/PandarScan,
/// nebula_msgs/NebulaPackets, robosense_msgs/RobosenseScan, rslidar_msgs/rslidarScan, rslidar_msg/RslidarPacket,
/// ouster_ros/PacketMsg and its kin.
[[nodiscard]] bool holds_packets(const std::string& type);
const char* read_packets(const std::string& type, MessageCursor cursor, PacketsMessage& message);

}  // namespace isobar::imports
