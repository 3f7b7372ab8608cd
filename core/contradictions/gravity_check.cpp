// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/gravity_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry.hpp"
#include "core/plausibility.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

constexpr double kMostTiltDeg = 45.0;
constexpr double kLevelCosine = 0.70710678118654752;
// As GravityAlignment: the mean specific force of a robot in m/s^2, and the same in g with the calibration of a cheap
// sensor.
constexpr PlausibleRange kGravityMS2{6.5, 13.0};
constexpr PlausibleRange kGravityG{0.75, 1.3};

}  // namespace

Eigen::Vector3d right_angled_mount(const Eigen::Vector3d& up_imu, double configured_yaw_deg) {
  constexpr std::array<std::array<double, 2>, 6> kRollPitchDeg{
      {{0.0, 0.0}, {180.0, 0.0}, {90.0, 0.0}, {-90.0, 0.0}, {0.0, 90.0}, {0.0, -90.0}}};
  Eigen::Vector3d best(0.0, 0.0, configured_yaw_deg);
  double best_up = -2.0;
  for (const auto& [roll, pitch] : kRollPitchDeg) {
    const double up = (rotation_from_rpy_deg({roll, pitch, 0.0}) * up_imu).z();
    if (up <= best_up + 1e-9) continue;
    best_up = up;
    best = {roll, pitch, configured_yaw_deg};
  }
  return best;
}

GravityCheck::GravityCheck(const Eigen::Vector3d& imu_rpy_deg)
    : imu_rpy_deg_(imu_rpy_deg), R_base_imu_(rotation_from_rpy_deg(imu_rpy_deg)) {}

void GravityCheck::add(const ImuSample& sample) {
  if (settled() || !plausible_stamp(sample.stamp_ns) || !sample.accel_m_s2.allFinite()) return;
  const std::int64_t since_ns = sample.stamp_ns - begin_ns_;
  if (samples_ > 0 && since_ns >= kWindowNs && since_ns < 2 * kWindowNs) end_window();
  if (samples_ == 0 || since_ns < 0 || since_ns >= kWindowNs) {
    begin_ns_ = sample.stamp_ns;
    sum_m_s2_.setZero();
    samples_ = 0;
  }
  sum_m_s2_ += sample.accel_m_s2;
  ++samples_;
}

void GravityCheck::end_window() {
  if (samples_ < kLeastSamples) return;
  const Eigen::Vector3d mean = sum_m_s2_ / samples_;
  const double length = mean.norm();
  const bool in_g = kGravityG.holds(length);
  if (!in_g && !kGravityMS2.holds(length)) return;
  const Eigen::Vector3d up_imu = mean / length;
  ++windows_;
  in_g_ += in_g ? 1 : 0;
  length_sum_ += length;
  up_sum_imu_ += up_imu;
  tilted_ += (R_base_imu_ * up_imu).z() < kLevelCosine ? 1 : 0;
}

double GravityCheck::angle_from_up_deg() const {
  const double cosine = (R_base_imu_ * up_sum_imu_.normalized()).z();
  return std::acos(std::clamp(cosine, -1.0, 1.0)) / kRadPerDeg;
}

bool GravityCheck::points_down() const { return mount().has_value() && angle_from_up_deg() > 135.0; }

std::optional<Finding> GravityCheck::mount() const {
  // Every second must say so, and all together: a robot that is carried or set upright while it starts does not.
  if (windows_ < kLeastWindows || tilted_ < windows_ || up_sum_imu_.norm() < 0.8 * windows_) return {};
  if (angle_from_up_deg() <= kMostTiltDeg) return {};
  const Eigen::Vector3d rpy_deg = right_angled_mount(up_sum_imu_.normalized(), imu_rpy_deg_.z());
  return Finding{.kind = Contradiction::kImuMount,
                 .measured = angle_from_up_deg(),
                 .remedy = {rpy_deg.x(), rpy_deg.y(), rpy_deg.z()},
                 .confidence = up_sum_imu_.norm() / windows_,
                 .evidence = static_cast<double>(windows_)};
}

std::optional<Finding> GravityCheck::unit() const {
  if (windows_ < kLeastWindows || in_g_ < windows_) return {};
  return Finding{.kind = Contradiction::kAccelUnit,
                 .measured = length_sum_ / windows_,
                 .remedy = {kGravity, 0.0, 0.0},
                 .confidence = 1.0,
                 .evidence = static_cast<double>(windows_)};
}

}  // namespace isobar
