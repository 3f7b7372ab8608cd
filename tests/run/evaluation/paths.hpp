// SPDX-License-Identifier: BSD-3-Clause
// Closed-form paths for the tests of the evaluation.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "run/evaluation/trajectory.hpp"

namespace isobar::test {

using evaluation::StampedPose;
using evaluation::Trajectory;

inline constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
inline constexpr double kDegree = std::numbers::pi / 180.0;

inline std::int64_t at_ns(double t_s) { return kStartNs + std::llround(t_s * 1e9); }

inline Eigen::Quaterniond yaw_rotation(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

/// Samples pose(t) every `step_s` from 0 to `duration_s`.
inline Trajectory sampled(double duration_s, double step_s, const std::function<StampedPose(double)>& pose) {
  Trajectory trajectory;
  const auto count = std::llround(duration_s / step_s);
  for (std::int64_t i = 0; i <= count; ++i) {
    const double t_s = static_cast<double>(i) * step_s;
    StampedPose sample = pose(t_s);
    sample.stamp_ns = at_ns(t_s);
    trajectory.poses.push_back(sample);
  }
  return trajectory;
}

/// Straight path: 1 m/s along x for `duration_s`, climbing `slope` per metre; the heading alone turns by
/// `turn_rad_m` per metre.
inline Trajectory straight(double duration_s, double step_s, double slope = 0.0, double turn_rad_m = 0.0) {
  return sampled(duration_s, step_s, [&](double t_s) {
    return StampedPose{0, {t_s, 0.0, slope * t_s}, yaw_rotation(turn_rad_m * t_s)};
  });
}

/// Generic path: a winding walk over hills with roll and pitch.
inline Trajectory winding(double duration_s, double step_s) {
  return sampled(duration_s, step_s, [](double t) {
    const Eigen::Quaterniond attitude = yaw_rotation(0.3 * t) *
                                        Eigen::AngleAxisd(0.1 * std::sin(t), Eigen::Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(0.05 * std::cos(2 * t), Eigen::Vector3d::UnitX());
    return StampedPose{0, {4 * std::sin(0.3 * t), t, 0.5 * std::sin(0.2 * t)}, attitude};
  });
}

inline Trajectory transformed(const Eigen::Isometry3d& transform, Trajectory trajectory) {
  for (StampedPose& pose : trajectory.poses) {
    pose.position_m = transform * pose.position_m;
    pose.attitude = Eigen::Quaterniond(transform.linear()) * pose.attitude;
  }
  return trajectory;
}

inline Eigen::Isometry3d yaw_and_shift(double yaw, const Eigen::Vector3d& shift_m) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = yaw_rotation(yaw).toRotationMatrix();
  transform.translation() = shift_m;
  return transform;
}

}  // namespace isobar::test
