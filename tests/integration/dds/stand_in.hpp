// SPDX-License-Identifier: BSD-3-Clause
// Data that the stand-in for isobard publishes, as functions of time: the ground truth for every receiver.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/estimates.hpp"
#include "ipc/topics.hpp"

namespace isobar::stand_in {

inline constexpr std::int64_t kPriorPeriodNs = 5'000'000;  // 200 Hz
inline constexpr int kPriorsPerScan = 20;                  // 10 Hz
inline constexpr double kSpeedMS = 0.5;
inline constexpr double kYawRad = 0.3;
inline constexpr double kClimbMS = 0.1;
inline constexpr std::uint32_t kScanPoints = 2000;
inline constexpr std::uint32_t kMapPoints = 150'000;
inline constexpr std::uint32_t kMapPieces = 3;  ///< of ipc::MapCloud::kMaxPoints each, but the last

/// Grid of the floor: 1.5 million cells, more than one piece holds.
inline constexpr std::uint32_t kGridWidth = 1500;
inline constexpr std::uint32_t kGridHeight = 1000;
inline constexpr double kGridResolutionM = 0.05;
inline constexpr double kGridOriginXM = -30.0;
inline constexpr double kGridOriginYM = 12.5;
inline constexpr std::int32_t kFloor = -1;
inline constexpr const char* kFloorName = "parking";
inline constexpr double kFloorZM = -3.5;

/// Pose on a straight, climbing drive along the map's x axis, `time_s` after the start.
inline Eigen::Isometry3d T_map_base(double time_s) {  // NOLINT(readability-identifier-naming)
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(kSpeedMS * time_s, 2.0, kClimbMS * time_s);
  T.linear() = Eigen::AngleAxisd(kYawRad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

inline double time_of(std::uint64_t step) { return static_cast<double>(step) * 1e-9 * kPriorPeriodNs; }

/// Prior with perfect wheel odometry in a shifted odometry frame.
inline Prior prior_at(std::int64_t start_ns, std::uint64_t step) {
  Prior prior;
  prior.stamp_ns = start_ns + static_cast<std::int64_t>(step) * kPriorPeriodNs;
  prior.T_odom_base = Eigen::Translation3d(-1.0, 4.0, 0.5) * T_map_base(time_of(step));
  prior.height_m = kClimbMS * time_of(step);
  prior.height_variance_m2 = 4e-4;
  prior.height_source = HeightSource::kDifferential;
  prior.v_base_m_s = T_map_base(0.0).linear().transpose() * Eigen::Vector3d(kSpeedMS, 0.0, kClimbMS);
  prior.velocity_variance_m2_s2 = 1e-4;
  prior.attitude_valid = true;
  prior.velocity_valid = true;
  return prior;
}

inline PoseEstimate pose_at(std::int64_t start_ns, std::uint64_t step) {
  PoseEstimate pose;
  const Prior prior = prior_at(start_ns, step);
  pose.stamp_ns = prior.stamp_ns;
  pose.sequence = static_cast<std::uint32_t>(step / kPriorsPerScan);
  pose.mode = PoseMode::kRegistered;
  pose.height_source = HeightSource::kDifferential;
  pose.T_map_base = T_map_base(time_of(step));
  pose.T_map_odom = pose.T_map_base * prior.T_odom_base.inverse();
  for (int row = 0; row < 6; ++row) {
    pose.covariance(row, row) = 0.01 * (row + 1);
  }
  pose.covariance(0, 5) = pose.covariance(5, 0) = 0.001;
  return pose;
}

/// Point i of every cloud.
inline ScanPoint point_at(std::uint32_t i) {
  ScanPoint point{};
  point.x_m = 0.25F * static_cast<float>(i);
  point.y_m = -1.5F;
  point.z_m = 0.001F * static_cast<float>(i % 1000);
  point.ring = static_cast<std::uint8_t>(i % 16);
  point.intensity = static_cast<std::uint8_t>(i % 256);
  return point;
}

/// Cell i of the grid: -1 … 100.
inline std::int8_t cell_at(std::uint32_t i) { return static_cast<std::int8_t>(i % 102) - 1; }

}  // namespace isobar::stand_in
