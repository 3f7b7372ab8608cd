// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/wheel_comparison.hpp"

#include <cmath>

#include "core/so3.hpp"

namespace isobar {

namespace {

// A straight stretch: its length by the wheels [m], long against the errors of two positions, and its largest turn
// [rad], 4 deg: tracks slip sideways in curves.
constexpr double kStraightM = 1.0;
constexpr double kStraightTurnRad = 0.07;
// Steepest stretch for the scale: on stairs tracks lose up to a tenth of their way. Sine of 6 deg.
constexpr double kLevelSlope = 0.1;
// Largest angle between both directions, and range of the scale: beyond, one of them is not the robot's motion.
constexpr double kPlausibleYawRad = 0.15;
constexpr double kPlausibleScale = 1.5;
// Turn about z that is compared [rad], 20 deg: long against the noise of the wheels' rate.
constexpr double kComparedTurnRad = 0.35;

bool plausible_scale(double scale) { return scale > 1.0 / kPlausibleScale && scale < kPlausibleScale; }

}  // namespace

void WheelComparison::interrupt() {
  started_ = false;
  gyro_turn_rad_ = 0.0;
  wheel_turn_rad_ = 0.0;
}

void WheelComparison::add(const WheelMotion& scan) {
  if (!scan.wheels_valid) {
    interrupt();
    return;
  }
  if (started_) {
    add_turn(scan);
    const bool turned =
        rotation_angle_rad(first_.q_odom_base.conjugate() * scan.q_odom_base) > kStraightTurnRad;
    const bool ends = (scan.p_odom_base_m - first_.p_odom_base_m).norm() >= kStraightM;
    if (!turned && ends) end_straight(scan);
    if (!turned && !ends) return;
  }
  started_ = true;
  first_ = scan;
}

void WheelComparison::end_straight(const WheelMotion& scan) {
  const Eigen::Vector3d by_scans_m =
      first_.q_map_base.conjugate() * (scan.p_map_base_m - first_.p_map_base_m);
  const Eigen::Vector3d by_wheels_m =
      first_.q_odom_base.conjugate() * (scan.p_odom_base_m - first_.p_odom_base_m);
  const double scale = by_scans_m.norm() / by_wheels_m.norm();
  // The step by the configured mount is exp(-e) times the true one: its direction is turned by minus the yaw.
  const double yaw_rad = std::remainder(
      std::atan2(by_wheels_m.y(), by_wheels_m.x()) - std::atan2(by_scans_m.y(), by_scans_m.x()), 2.0 * M_PI);
  if (!plausible_scale(scale) || std::abs(yaw_rad) > kPlausibleYawRad) return;
  yaw_rad_.add(yaw_rad);
  const double climb_m = scan.p_map_base_m.z() - first_.p_map_base_m.z();
  if (std::abs(climb_m) <= kLevelSlope * by_scans_m.norm()) distance_scale_.add(scale);
}

void WheelComparison::add_turn(const WheelMotion& scan) {
  gyro_turn_rad_ += scan.gyro_turn_z_rad;
  wheel_turn_rad_ += scan.wheel_turn_rad;
  if (std::isfinite(wheel_turn_rad_) && std::abs(gyro_turn_rad_) < kComparedTurnRad) return;
  const double scale = gyro_turn_rad_ / wheel_turn_rad_;
  if (std::isfinite(wheel_turn_rad_) && plausible_scale(scale)) turn_scale_.add(scale);
  gyro_turn_rad_ = 0.0;
  wheel_turn_rad_ = 0.0;
}

}  // namespace isobar
