// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 messages in CDR, built from Isobar's values. Stamps in ns since the epoch, lengths in metres, angles in rad.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "run/mcap/cdr_writer.hpp"

namespace isobar::mcap {

using Cdr = std::vector<std::uint8_t>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A pose of base_link, or of a frame in another.
struct FramePose {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

/// geometry_msgs/PoseWithCovarianceStamped; order of the covariance: x, y, z, roll, pitch, yaw.
Cdr pose_message(const FramePose& pose, const std::string& frame, const Matrix6& covariance);

/// tf2_msgs/TFMessage of one transform.
Cdr transform_message(const FramePose& pose, const std::string& parent, const std::string& child);

/// nav_msgs/Path.
Cdr path_message(std::span<const FramePose> poses, const std::string& frame);

/// sensor_msgs/PointCloud2 of x, y, z (float32).
Cdr cloud_message(std::int64_t stamp_ns, const std::string& frame,
                  std::span<const std::array<float, 3>> points_m);

/// sensor_msgs/Imu; the orientation is unknown (ROS: first covariance -1) where the sensor tells none.
Cdr imu_message(const ImuSample& sample, const std::string& frame);

/// sensor_msgs/FluidPressure.
Cdr pressure_message(const PressureSample& sample, const std::string& frame);

/// geometry_msgs/TwistStamped.
Cdr twist_message(const WheelSample& sample, const std::string& frame);

/// isobar_msgs/Altitude. NaN: unknown.
struct Altitude {
  std::int64_t stamp_ns = 0;
  double height_m = 0.0;
  double variance_m2 = 0.0;
  double bias_m = 0.0;
  double bias_variance_m2 = 0.0;
  double innovation_m = 0.0;
  double airflow_s2_m = 0.0;
  double airflow_variance_s4_m2 = 0.0;
  bool faulty = false;
  std::string source{};
  std::string drifting{};
};
Cdr altitude_message(const Altitude& altitude, const std::string& frame);

/// std_msgs/Float64.
Cdr number_message(double value);

}  // namespace isobar::mcap
