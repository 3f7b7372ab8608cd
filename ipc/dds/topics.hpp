// SPDX-License-Identifier: BSD-3-Clause
// Table of the DDS topics: ROS 2 name, type, delivery. ROS topic /a is rt/a in DDS.
#pragma once

#include <ros2.h>

#include <cstdint>
#include <string>

#include "ipc/dds/qos.hpp"

namespace isobar::dds {

// Short names for the generated C types of the ROS 2 messages.
using OdometryMessage = nav_msgs_msg_dds__Odometry_;
using PoseMessage = geometry_msgs_msg_dds__PoseWithCovarianceStamped_;
using TwistMessage = geometry_msgs_msg_dds__TwistWithCovarianceStamped_;
using TfMessage = tf2_msgs_msg_dds__TFMessage_;
using AltitudeMessage = isobar_msgs_msg_dds__Altitude_;
using CloudMessage = sensor_msgs_msg_dds__PointCloud2_;
using GridMessage = nav_msgs_msg_dds__OccupancyGrid_;
using Int32Message = std_msgs_msg_dds__Int32_;
using StringMessage = std_msgs_msg_dds__String_;
using DiagnosticsMessage = diagnostic_msgs_msg_dds__DiagnosticArray_;
using PressureMessage = sensor_msgs_msg_dds__FluidPressure_;
using TemperatureMessage = sensor_msgs_msg_dds__Temperature_;
using ImuMessage = sensor_msgs_msg_dds__Imu_;

/// One row of the table below.
template <class Message>
struct DdsTopic {
  const char* name;  ///< default ROS name, without the leading slash
  const dds_topic_descriptor_t* descriptor;
  Delivery delivery;
  int depth;
  bool is_global;  ///< not prefixed with the robot's namespace
};

namespace topics {

// clang-format off
inline const DdsTopic<OdometryMessage> kOdom{"odom", &nav_msgs_msg_dds__Odometry__desc, Delivery::kReliable, 10, false};
inline const DdsTopic<PoseMessage> kPose{"pose", &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, Delivery::kReliable, 10, false};
inline const DdsTopic<TfMessage> kTf{"tf", &tf2_msgs_msg_dds__TFMessage__desc, Delivery::kReliable, 100, true};
inline const DdsTopic<TfMessage> kTfStatic{"tf_static", &tf2_msgs_msg_dds__TFMessage__desc, Delivery::kLatched, 1, true};
inline const DdsTopic<AltitudeMessage> kAltitude{"altitude", &isobar_msgs_msg_dds__Altitude__desc, Delivery::kReliable, 10, false};
inline const DdsTopic<CloudMessage> kRegisteredScan{"registered_scan", &sensor_msgs_msg_dds__PointCloud2__desc, Delivery::kReliable, 5, false};
inline const DdsTopic<CloudMessage> kMapCloud{"map_cloud", &sensor_msgs_msg_dds__PointCloud2__desc, Delivery::kLatched, 1, false};
inline const DdsTopic<GridMessage> kMap{"map", &nav_msgs_msg_dds__OccupancyGrid__desc, Delivery::kLatched, 1, false};
inline const DdsTopic<Int32Message> kFloor{"floor", &std_msgs_msg_dds__Int32__desc, Delivery::kLatched, 1, false};
inline const DdsTopic<StringMessage> kFloorName{"floor_name", &std_msgs_msg_dds__String__desc, Delivery::kLatched, 1, false};
inline const DdsTopic<DiagnosticsMessage> kDiagnostics{"diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc, Delivery::kReliable, 10, true};

// Topics of a base station, with its name as namespace, such as "base".
inline const DdsTopic<PressureMessage> kBasePressure{"fluid_pressure", &sensor_msgs_msg_dds__FluidPressure__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<TemperatureMessage> kBaseTemperature{"temperature", &sensor_msgs_msg_dds__Temperature__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<CloudMessage> kPoints{"points", &sensor_msgs_msg_dds__PointCloud2__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<PressureMessage> kPressure{"fluid_pressure", &sensor_msgs_msg_dds__FluidPressure__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<ImuMessage> kImu{"imu/data", &sensor_msgs_msg_dds__Imu__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<OdometryMessage> kWheel{"wheel/odom", &nav_msgs_msg_dds__Odometry__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<TwistMessage> kWheelTwist{"wheel/twist", &geometry_msgs_msg_dds__TwistWithCovarianceStamped__desc, Delivery::kBestEffort, 5, false};
inline const DdsTopic<PoseMessage> kInitialPose{"initialpose", &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, Delivery::kReliable, 5, false};
// clang-format on

}  // namespace topics

/// DDS name of a topic: "rt/odom"; in the namespace robot1, "rt/robot1/odom".
/// @param name ROS name instead of that of the table; empty: that of the table
template <class Message>
[[nodiscard]] std::string dds_name(const DdsTopic<Message>& topic, const std::string& ros_namespace,
                                   const std::string& name = {}) {
  const std::string last = name.empty() ? topic.name : name;
  const bool plain = topic.is_global || ros_namespace.empty();
  return plain ? "rt/" + last : "rt/" + ros_namespace + "/" + last;
}

}  // namespace isobar::dds
