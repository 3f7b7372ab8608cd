// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/ros_messages.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace isobar::imports {
namespace {

constexpr const char* kShort = "is shorter than its type says";
constexpr const char* kNoAttitude = "has an attitude that is no rotation";

void read_header(MessageCursor& cursor, MessageHeader& header) {
  if (cursor.is_ros1()) cursor.get<std::uint32_t>();  // seq
  header.stamp_ns = cursor.time_ns();
  header.frame_id = cursor.text();
}

Eigen::Vector3d read_vector(MessageCursor& cursor) {
  const double x = cursor.get<double>();
  const double y = cursor.get<double>();
  return {x, y, cursor.get<double>()};
}

Eigen::Quaterniond read_quaternion(MessageCursor& cursor) {
  const double x = cursor.get<double>();
  const double y = cursor.get<double>();
  const double z = cursor.get<double>();
  return {cursor.get<double>(), x, y, z};
}

/// False for what is no rotation; a quaternion of few decimals is made one.
bool set_pose(const Eigen::Vector3d& p, const Eigen::Quaterniond& q, Eigen::Isometry3d& pose) {
  constexpr double kMostOff = 0.1;
  if (!p.allFinite() || !(std::abs(q.norm() - 1.0) < kMostOff)) return false;
  pose = Eigen::Translation3d(p) * q.normalized();
  return true;
}

const char* read_pose_fields(MessageCursor& cursor, Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = read_vector(cursor);
  const Eigen::Quaterniond q = read_quaternion(cursor);
  if (!cursor.ok()) return kShort;
  return set_pose(p, q, pose) ? nullptr : kNoAttitude;
}

/// Diagonal element of a covariance 6x6; NaN where the sender states none.
double variance_of(const std::array<double, 36>& covariance, std::size_t axis) {
  const double variance = covariance[7 * axis];
  return std::isfinite(variance) && variance > 0.0 ? variance : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const char* read_imu(MessageCursor cursor, MessageHeader& header, ImuSample& sample) {
  read_header(cursor, header);
  sample = {};
  sample.stamp_ns = header.stamp_ns;
  const Eigen::Quaterniond q = read_quaternion(cursor);
  const double attitude_variance = cursor.get<double>();
  cursor.skip<double>(8);
  sample.gyro_rad_s = read_vector(cursor);
  cursor.skip<double>(9);
  sample.accel_m_s2 = read_vector(cursor);
  if (!cursor.ok()) return kShort;
  // Covariance -1: no attitude, by the message's definition; many senders leave all zeros instead.
  constexpr double kMostOff = 0.1;
  sample.has_attitude = attitude_variance >= 0.0 && std::abs(q.norm() - 1.0) < kMostOff;
  // An IMU without attitude often says "no rotation" all the time; the caller, who sees them all, tells.
  sample.q_world_imu = sample.has_attitude ? q.normalized() : Eigen::Quaterniond::Identity();
  return sample.gyro_rad_s.allFinite() && sample.accel_m_s2.allFinite() ? nullptr
                                                                        : "has values that are no numbers";
}

const char* read_pressure(MessageCursor cursor, MessageHeader& header, PressureSample& sample) {
  read_header(cursor, header);
  sample = {};
  sample.stamp_ns = header.stamp_ns;
  sample.pressure_pa = cursor.get<double>();
  sample.temperature_c = std::numeric_limits<double>::quiet_NaN();
  const double variance = cursor.get<double>();
  if (!cursor.ok()) return kShort;
  if (std::isfinite(variance) && variance > 0.0) sample.variance_pa2 = variance;
  return std::isfinite(sample.pressure_pa) ? nullptr : "has values that are no numbers";
}

const char* read_temperature(MessageCursor cursor, MessageHeader& header, double& temperature_c) {
  read_header(cursor, header);
  temperature_c = cursor.get<double>();
  return cursor.ok() ? nullptr : kShort;
}

const char* read_odometry(MessageCursor cursor, OdometryMessage& message) {
  read_header(cursor, message.pose.header);
  message.pose.child = cursor.text();
  if (const char* rule = read_pose_fields(cursor, message.pose.pose); rule != nullptr) return rule;
  cursor.skip<double>(36);
  const Eigen::Vector3d v = read_vector(cursor);
  const Eigen::Vector3d w = read_vector(cursor);
  std::array<double, 36> covariance{};
  for (double& element : covariance) element = cursor.get<double>();
  if (!cursor.ok()) return kShort;
  message.twist = {};
  message.twist.stamp_ns = message.pose.header.stamp_ns;
  message.twist.vx_m_s = v.x();
  message.twist.vy_m_s = v.y();
  message.twist.wz_rad_s = w.z();
  message.twist.vx_variance_m2_s2 = variance_of(covariance, 0);
  message.twist.vy_variance_m2_s2 = variance_of(covariance, 1);
  message.twist.wz_variance_rad2_s2 = variance_of(covariance, 5);
  return v.allFinite() && w.allFinite() ? nullptr : "has values that are no numbers";
}

const char* read_twist(MessageCursor cursor, MessageHeader& header, WheelSample& sample) {
  read_header(cursor, header);
  const Eigen::Vector3d v = read_vector(cursor);
  const Eigen::Vector3d w = read_vector(cursor);
  if (!cursor.ok()) return kShort;
  sample = {};
  sample.stamp_ns = header.stamp_ns;
  sample.vx_m_s = v.x();
  sample.vy_m_s = v.y();
  sample.wz_rad_s = w.z();
  return v.allFinite() && w.allFinite() ? nullptr : "has values that are no numbers";
}

const char* read_pose(MessageCursor cursor, StampedPose& pose) {
  read_header(cursor, pose.header);
  pose.child.clear();
  return read_pose_fields(cursor, pose.pose);
}

const char* read_transform(MessageCursor& cursor, StampedPose& pose) {
  read_header(cursor, pose.header);
  pose.child = cursor.text();
  return read_pose_fields(cursor, pose.pose);
}

const char* read_transforms(MessageCursor cursor, std::vector<StampedPose>& poses) {
  constexpr std::size_t kLeastBytes = 72;  // stamp, two names, seven numbers
  poses.clear();
  const std::uint32_t count = cursor.count(kLeastBytes);
  if (!cursor.ok()) return kShort;
  for (std::uint32_t i = 0; i < count; ++i) {
    StampedPose pose;
    // One that is no rotation does not spoil the others; one that is cut ends the message.
    if (read_transform(cursor, pose) == nullptr) poses.push_back(std::move(pose));
    if (!cursor.ok()) return kShort;
  }
  return nullptr;
}

const char* read_string(MessageCursor cursor, std::string& text) {
  text = cursor.text();
  return cursor.ok() ? nullptr : kShort;
}

}  // namespace isobar::imports
