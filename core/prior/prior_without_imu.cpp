// SPDX-License-Identifier: BSD-3-Clause
// PriorEstimator of a robot without an IMU: the way of the wheels on a plane, and the height of the air.
#include <algorithm>
#include <cmath>

#include "core/pose_carrying.hpp"
#include "core/prior/prior_state.hpp"
#include "core/prior/wheel_noise.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Spectral density of the vertical acceleration that nobody measures [m^2/s^3]: ramps, stairs and lifts change the
// vertical speed by 0.3 m/s in a second.
constexpr double kUnfeltAccelDensity = 0.1;
// Turn rate of wheels against the robot's: constant part [rad/s], and share by which skid steering and tracks slip,
// 1 sigma.
constexpr double kTurnSigmaRadS = 0.02;
constexpr double kTurnSigmaShare = 0.1;
// Longest step [s]: a pause of the clock moves nothing.
constexpr double kLongestStepS = 1.0;

}  // namespace

bool PriorEstimator::advance(std::int64_t stamp_ns, Prior& out) {
  State& s = *state_;
  if (!plausible_stamp(stamp_ns)) return false;
  const double step_s = s.started() ? seconds_between(s.advanced_ns, stamp_ns) : 0.0;
  if (step_s < -s.config.limits.imu_restart_s) {
    s.set_clock_back();
  } else if (s.started() && step_s <= 0.0) {
    return false;
  }
  const double dt_s = std::clamp(step_s, 0.0, kLongestStepS);
  s.advanced_ns = stamp_ns;
  if (s.aligned_ns == 0) s.aligned_ns = stamp_ns;
  s.start_height();
  s.height.predict(0.0, dt_s, kUnfeltAccelDensity);
  s.roll_on_plane(stamp_ns);
  s.use_climb(dt_s, false, s.altimeter.robot_lost(stamp_ns, s.config.height.barometer_timeout_s));
  s.air_ride.add(s.wheels_stand(), s.altimeter_m, s.height.vz_m_s(), dt_s);
  s.altimeter.set_time(stamp_ns);
  s.watch_barometers();
  out = s.prior_of_wheels();
  return true;
}

void PriorEstimator::State::set_clock_back() {
  altimeter.restart_clock();
  wheels = WheelOdometer(config.dead_reckoning);
  wheel_turn_rad = 0.0;
}

void PriorEstimator::State::roll_on_plane(std::int64_t stamp_ns) {
  const Eigen::Vector2d rolled_m = wheels.take_displacement(stamp_ns);
  const double turn_rad = wheels.turn_rad(stamp_ns) - wheel_turn_rad;
  const Eigen::Quaterniond q_before(rotation_about_z(plane_yaw_rad));
  p_odom_base += midpoint_step(q_before, {0.0, 0.0, 0.5 * turn_rad}, {rolled_m.x(), rolled_m.y(), 0.0});
  plane_yaw_rad += turn_rad;
  wheel_turn_rad += turn_rad;
}

Prior PriorEstimator::State::prior_of_wheels() const {
  Prior out;
  out.stamp_ns = advanced_ns;
  out.T_odom_base.translation() = p_odom_base;
  out.T_odom_base.linear() = rotation_about_z(plane_yaw_rad);
  out.roll_pitch_variance_rad2 = 1.0;
  out.velocity_variance_m2_s2 = squared(config.attitude.free_velocity_sigma_m_s);
  out.wheel_turn_rad = wheel_turn_rad;
  fill_wheels(advanced_ns, out);
  if (out.velocity_valid) {
    const double rate_rad_s = wheels.last().wz_rad_s;
    out.w_base_rad_s.z() = rate_rad_s;
    out.yaw_bias_variance_rad2_s2 = squared(kTurnSigmaShare * rate_rad_s);
    out.yaw_rate_variance_rad2_s2 =
        constant_variance(wheels.last().wz_variance_rad2_s2, kTurnSigmaRadS) + out.yaw_bias_variance_rad2_s2;
  }
  fill_height(advanced_ns, out);
  fill_altimeter(out);
  out.ground_moves = air_ride.rides();
  return out;
}

}  // namespace isobar
