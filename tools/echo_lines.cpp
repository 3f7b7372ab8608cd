// SPDX-License-Identifier: BSD-3-Clause
#include "tools/echo_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <string_view>

#include "core/geometry.hpp"
#include "ipc/dds/messages.hpp"

namespace isobar::tools {

namespace {

double seconds(const dds::HeaderMessage& header) {
  return static_cast<double>(header.stamp.sec) + 1e-9 * static_cast<double>(header.stamp.nanosec);
}

/// Rotation about z of a gravity-aligned frame [degrees].
double yaw_deg(const geometry_msgs_msg_dds__Quaternion_& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z)) / kRadPerDeg;
}

/// A text of a received message; empty when the sender left it null.
const char* shown(const char* value) { return value != nullptr ? value : ""; }

}  // namespace

void print_line(const char* topic, const dds::PoseMessage& message) {
  const auto& [position, orientation] = message.pose.pose;
  std::printf("%s  t %.3f s  x %8.3f  y %8.3f  z %7.3f m (+-%.3f)  yaw %7.2f deg\n", topic,
              seconds(message.header), position.x, position.y, position.z,
              std::sqrt(std::max(0.0, message.pose.covariance[14])), yaw_deg(orientation));
}

void print_line(const char* topic, const dds::OdometryMessage& message) {
  const auto& [position, orientation] = message.pose.pose;
  std::printf("%s  t %.3f s  x %8.3f  y %8.3f  z %7.3f m  yaw %7.2f deg  v %6.3f m/s  w %7.4f rad/s\n", topic,
              seconds(message.header), position.x, position.y, position.z, yaw_deg(orientation),
              message.twist.twist.linear.x, message.twist.twist.angular.z);
}

void print_line(const char* topic, const dds::AltitudeMessage& message) {
  std::printf("%s  t %.3f s  height %7.3f m (+-%.3f)  %s", topic, seconds(message.header), message.height,
              std::sqrt(std::max(0.0, message.variance)), shown(message.source));
  if (!std::isnan(message.bias)) {
    std::printf("  bias %6.3f m (+-%.3f)  innovation %6.3f m  airflow %.1f mm per (m/s)^2 (+-%.1f)%s",
                message.bias, std::sqrt(message.bias_variance), message.innovation, 1e3 * message.airflow,
                1e3 * std::sqrt(message.airflow_variance), message.faulty ? "  faulty" : "");
  }
  if (std::string_view(shown(message.drifting)) != "none")
    std::printf("  drifting: %s", shown(message.drifting));
  std::printf("\n");
}

void print_line(const char* topic, const dds::TfMessage& message) {
  for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
    const auto& [header, child, transform] = message.transforms._buffer[i];
    std::printf("%s  t %.3f s  %s -> %s  x %8.3f  y %8.3f  z %7.3f m  yaw %7.2f deg\n", topic,
                seconds(header), shown(header.frame_id), shown(child), transform.translation.x,
                transform.translation.y, transform.translation.z, yaw_deg(transform.rotation));
  }
}

void print_line(const char* topic, const dds::GridMessage& message) {
  const auto& info = message.info;
  const std::span<const std::uint8_t> cells(message.data._buffer, message.data._length);
  const auto known = std::count_if(cells.begin(), cells.end(), [](std::uint8_t cell) { return cell <= 100; });
  std::printf("%s  t %.3f s  %u x %u cells of %.3f m  from x %.3f  y %.3f  z %.3f m  %ld known\n", topic,
              seconds(message.header), info.width, info.height, static_cast<double>(info.resolution),
              info.origin.position.x, info.origin.position.y, info.origin.position.z,
              static_cast<long>(known));
}

void print_line(const char* topic, const dds::CloudMessage& message) {
  std::printf("%s  t %.3f s  %u points of %u bytes in %s  ", topic, seconds(message.header),
              message.width * message.height, message.point_step, shown(message.header.frame_id));
  for (std::uint32_t i = 0; i < message.fields._length; ++i)
    std::printf("%s%s", i == 0 ? "" : ", ", shown(message.fields._buffer[i].name));
  std::printf("\n");
}

void print_line(const char* topic, const dds::PressureMessage& message) {
  std::printf("%s  t %.3f s  %.2f Pa (+-%.2f)  %s\n", topic, seconds(message.header), message.fluid_pressure,
              std::sqrt(std::max(0.0, message.variance)), shown(message.header.frame_id));
}

void print_line(const char* topic, const dds::TemperatureMessage& message) {
  std::printf("%s  t %.3f s  %.2f degC  %s\n", topic, seconds(message.header), message.temperature,
              shown(message.header.frame_id));
}

void print_line(const char* topic, const dds::ImuMessage& message) {
  const auto& rate = message.angular_velocity;
  const auto& accel = message.linear_acceleration;
  std::printf("%s  t %.3f s  rate %8.4f %8.4f %8.4f rad/s  accel %8.3f %8.3f %8.3f m/s^2  %s\n", topic,
              seconds(message.header), rate.x, rate.y, rate.z, accel.x, accel.y, accel.z,
              shown(message.header.frame_id));
}

void print_line(const char* topic, const dds::TwistMessage& message) {
  const auto& twist = message.twist.twist;
  std::printf("%s  t %.3f s  forward %7.3f m/s  left %7.3f m/s  yaw rate %7.4f rad/s  %s\n", topic,
              seconds(message.header), twist.linear.x, twist.linear.y, twist.angular.z,
              shown(message.header.frame_id));
}

void print_line(const char* topic, const dds::Int32Message& message) {
  std::printf("%s  %d\n", topic, message.data);
}

void print_line(const char* topic, const dds::StringMessage& message) {
  std::printf("%s  %s\n", topic, shown(message.data));
}

/// Prints the statuses that are not ok, or one line when all are.
void print_line(const char* topic, const dds::DiagnosticsMessage& message) {
  constexpr std::array<const char*, 4> kLevels{"ok", "warning", "error", "stale"};
  std::uint32_t bad = 0;
  for (std::uint32_t i = 0; i < message.status._length; ++i) {
    const auto& status = message.status._buffer[i];
    if (status.level == 0) {
      continue;
    }
    ++bad;
    const char* value = status.values._length > 0 ? shown(status.values._buffer[0].value) : "";
    std::printf("%s  %s  %s  %s  %s\n", topic, kLevels[std::min<std::size_t>(status.level, 3)],
                shown(status.name), shown(status.message), value);
  }
  if (bad == 0) {
    std::printf("%s  t %.3f s  all %u entries ok\n", topic, seconds(message.header), message.status._length);
  }
}

}  // namespace isobar::tools
