// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/held_pose.hpp"

#include "core/geometry.hpp"

namespace isobar {

namespace {

// Offset of a scan of a standing lidar from the pose that its map was made at (rooms full of things: 7 mm), and the
// difference of two of them: a speed of 5 cm/s at 10 scans a second is no standstill.
constexpr double kLargestOffsetM = 0.015;
constexpr double kLargestChangeM = 0.005;
// Scans whose mean offset the hold begins with, and the distance from it within which the map takes a scan.
constexpr int kFirstScans = 5;
constexpr double kSteadyM = 0.004;
// Without wheels the map takes every 20th scan: what moves by 1 cm/s has left the held pose by then.
constexpr int kMapStride = 20;
constexpr double kLargestTurnRad = 0.2 * kRadPerDeg;

}  // namespace

bool HeldPose::holds(bool may_stand, const Eigen::Isometry3d& T_held, const Eigen::Isometry3d& T_match) {
  const Eigen::Vector3d offset_m = T_match.translation() - T_held.translation();
  const Eigen::Vector3d change_m = offset_m - offset_m_;
  const double turn_rad =
      rotation_angle_rad(Eigen::Quaterniond(T_held.linear().transpose() * T_match.linear()));
  const bool close = offset_m.norm() < kLargestOffsetM && (scans_ == 0 || change_m.norm() < kLargestChangeM);
  const bool held = may_stand && close && turn_rad < kLargestTurnRad;
  if (!held) {
    *this = HeldPose();
    return false;
  }
  offset_m_ = offset_m;
  ++scans_;
  if (scans_ <= kFirstScans) first_offset_m_ += (offset_m - first_offset_m_) / scans_;
  steady_ = (offset_m - first_offset_m_).norm() < kSteadyM;
  return true;
}

bool HeldPose::for_map(bool wheels_stand) const {
  return scans_ <= kFirstScans || (steady_ && (wheels_stand || scans_ % kMapStride == 0));
}

}  // namespace isobar
