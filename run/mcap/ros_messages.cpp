// SPDX-License-Identifier: BSD-3-Clause
#include "run/mcap/ros_messages.hpp"

namespace isobar::mcap {

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::uint8_t kFloat32 = 7;  // of sensor_msgs/PointField

void put_header(std::int64_t stamp_ns, const std::string& frame, CdrWriter& out) {
  // Seconds rounded down, so that nanoseconds are never negative.
  const std::int64_t rest = (stamp_ns % kSecondNs + kSecondNs) % kSecondNs;
  out.put(static_cast<std::int32_t>((stamp_ns - rest) / kSecondNs)).put(static_cast<std::uint32_t>(rest));
  out.text(frame);
}

void put_vector(const Eigen::Vector3d& vector, CdrWriter& out) {
  out.put(vector.x()).put(vector.y()).put(vector.z());
}

void put_quaternion(const Eigen::Quaterniond& q, CdrWriter& out) {
  out.put(q.x()).put(q.y()).put(q.z()).put(q.w());
}

void put_pose(const FramePose& pose, CdrWriter& out) {
  put_vector(pose.position_m, out);
  put_quaternion(pose.attitude, out);
}

/// float64[9] of a quantity whose covariance is unknown; `first`: -1 says that the quantity itself is.
void put_unknown_covariance(double first, CdrWriter& out) {
  out.put(first);
  for (int i = 1; i < 9; ++i) out.put(0.0);
}

}  // namespace

Cdr pose_message(const FramePose& pose, const std::string& frame, const Matrix6& covariance) {
  CdrWriter out;
  put_header(pose.stamp_ns, frame, out);
  put_pose(pose, out);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) out.put(covariance(row, column));
  }
  return out.bytes();
}

Cdr transform_message(const FramePose& pose, const std::string& parent, const std::string& child) {
  CdrWriter out;
  out.count(1);
  put_header(pose.stamp_ns, parent, out);
  out.text(child);
  put_pose(pose, out);  // translation, rotation: the same members
  return out.bytes();
}

Cdr path_message(std::span<const FramePose> poses, const std::string& frame) {
  CdrWriter out;
  put_header(poses.empty() ? 0 : poses.front().stamp_ns, frame, out);
  out.count(poses.size());
  for (const FramePose& pose : poses) {
    put_header(pose.stamp_ns, frame, out);
    put_pose(pose, out);
  }
  return out.bytes();
}

Cdr cloud_message(std::int64_t stamp_ns, const std::string& frame,
                  std::span<const std::array<float, 3>> points_m) {
  constexpr std::uint32_t kPointBytes = 3 * sizeof(float);
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  CdrWriter out;
  put_header(stamp_ns, frame, out);
  out.count(1).count(points_m.size());  // height, width
  out.count(kNames.size());
  for (std::uint32_t i = 0; i < kNames.size(); ++i) {
    out.text(kNames[i])
        .put(static_cast<std::uint32_t>(i * sizeof(float)))
        .put(kFloat32)
        .put(std::uint32_t{1});
  }
  const std::size_t bytes = points_m.size() * kPointBytes;
  out.put(std::uint8_t{0}).put(kPointBytes).count(bytes);  // little endian, bytes of a point, of the row
  out.count(bytes).raw({reinterpret_cast<const std::uint8_t*>(points_m.data()), bytes});
  out.put(std::uint8_t{1});  // dense
  return out.bytes();
}

Cdr imu_message(const ImuSample& sample, const std::string& frame) {
  CdrWriter out;
  put_header(sample.stamp_ns, frame, out);
  put_quaternion(sample.has_attitude ? sample.q_world_imu : Eigen::Quaterniond::Identity(), out);
  put_unknown_covariance(sample.has_attitude ? 0.0 : -1.0, out);
  put_vector(sample.gyro_rad_s, out);
  put_unknown_covariance(0.0, out);
  put_vector(sample.accel_m_s2, out);
  put_unknown_covariance(0.0, out);
  return out.bytes();
}

Cdr pressure_message(const PressureSample& sample, const std::string& frame) {
  CdrWriter out;
  put_header(sample.stamp_ns, frame, out);
  out.put(sample.pressure_pa).put(sample.variance_pa2);
  return out.bytes();
}

Cdr twist_message(const WheelSample& sample, const std::string& frame) {
  CdrWriter out;
  put_header(sample.stamp_ns, frame, out);
  put_vector({sample.vx_m_s, sample.vy_m_s, 0.0}, out);
  put_vector({0.0, 0.0, sample.wz_rad_s}, out);
  return out.bytes();
}

Cdr altitude_message(const Altitude& altitude, const std::string& frame) {
  CdrWriter out;
  put_header(altitude.stamp_ns, frame, out);
  out.put(altitude.height_m).put(altitude.variance_m2).text(altitude.source);
  out.put(altitude.bias_m).put(altitude.bias_variance_m2).put(altitude.innovation_m);
  out.put(altitude.airflow_s2_m).put(altitude.airflow_variance_s4_m2);
  out.put(static_cast<std::uint8_t>(altitude.faulty)).text(altitude.drifting);
  return out.bytes();
}

Cdr number_message(double value) { return CdrWriter().put(value).bytes(); }

}  // namespace isobar::mcap
