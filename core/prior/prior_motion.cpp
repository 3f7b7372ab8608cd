// SPDX-License-Identifier: BSD-3-Clause
// PriorEstimator: alignment, and one step of all filters per IMU sample.
#include <algorithm>
#include <cmath>

#include "core/pose_carrying.hpp"
#include "core/prior/prior_state.hpp"
#include "core/short_pause.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Interval of bounded-velocity updates of a platform without wheels.
constexpr double kBoundedUpdateS = 0.1;
// A gap of the IMU is bridged at constant rate for this long at each end; between, only the wheels' turn rate
// is used.
constexpr double kConstantRateS = 0.3;
// Unobserved turn during a gap: 1 sigma per second, and its upper bound.
constexpr double kUnseenRateRadS = 0.2;
constexpr double kUnseenTurnRad = 0.3;
// Error of roll and pitch from the first accelerations of a robot that may be moving, 1 sigma.
constexpr double kStartSigmaRad = 0.02;
// Vertical speed at the start, 1 sigma: on wheels, and of a hanging platform.
constexpr double kStartClimbOnWheelsMS = 0.05;
constexpr double kStartClimbHangingMS = 0.3;
// A continued height waits for pressures up to this long after the alignment: a base station settles in 1 s.
constexpr double kWaitForPressureS = 1.8;
// The same for a base station, whose network may come late.
constexpr double kWaitForBaseS = 10.0;
// Change of the vertical speed over a short pause, 1 sigma: stairs begin or end.
constexpr double kUnseenClimbMS = 0.25;
// Unseen climb that stairs do not explain, and the vertical speed of an elevator, 1 sigma.
constexpr double kRideM = 0.6;
constexpr double kRideSigmaMS = 0.7;
// Fastest lift in a high building; more is a shock to the accelerometer.
constexpr double kFastestClimbMS = 10.0;
// Speed of the wheels below which a robot stands.
constexpr double kStandMS = 0.05;
// Height from one pressure against the base station, with turbulence, 1 sigma.
constexpr double kPressureSigmaM = 0.2;
// Vertical motion of a robot that is switched off, 1 sigma: it is pushed over a threshold.
constexpr double kStandSigmaM = 0.05;
// The pressure contradicts: a difference that neither turbulence nor a ventilation zone makes.
constexpr double kMovedM = 1.0;
constexpr double kMovedSigmas = 5.0;
constexpr double kMovedSigmaM = 0.3;
// Mean gyro bias from the IMU's own attitude, 1 sigma.
constexpr double kDeviceBiasSigmaRadS = 0.01;

}  // namespace

void PriorEstimator::State::align(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s) {
  const Eigen::Vector3d turn = (gyro - attitude.gyro_bias_rad_s()) * dt_s;
  const GravityAlignment::Status status = alignment.add(turn, force, dt_s);
  if (status == GravityAlignment::Status::kWrongGravity) ++counters.imu_wrong_gravity;
  if (status != GravityAlignment::Status::kAligned) return;
  attitude.start(alignment.force_sum(), yaw_before_rad, kStartSigmaRad);
  alignment.restart();
  if (aligned_ns == 0) aligned_ns = now_ns();
  start_height();
}

void PriorEstimator::State::start_height() {
  if (height.started()) return;
  const std::int64_t start_ns = now_ns();
  // A continued height waits for the pressures that it continues with.
  const bool incomplete = reading_source == HeightSource::kNone || altimeter.waits_for_base();
  if (resumed.known && incomplete && seconds_between(aligned_ns, start_ns) < wait_for_pressure_s(start_ns))
    return;
  height_start_ns = start_ns;
  const double vz_sigma_m_s = wheels.valid(start_ns) ? kStartClimbOnWheelsMS : kStartClimbHangingMS;
  if (resumed.known) {
    continue_height(vz_sigma_m_s);
  } else {
    height.start(above_base(p_base_imu), vz_sigma_m_s);
  }
}

// After a night the robot may be on another floor, which only the base station tells; its network may come late.
double PriorEstimator::State::wait_for_pressure_s(std::int64_t start_ns) const {
  const bool had_base = std::any_of(resumed.station_known.begin(), resumed.station_known.end(),
                                    [](bool known) { return known; });
  const bool short_pause = is_short_pause(seconds_between(resumed.stamp_ns, start_ns));
  return had_base && !short_pause ? kWaitForBaseS : kWaitForPressureS;
}

// After a short pause the robot may be climbing, or riding; after a longer one it stands where it was, unless the
// pressure contradicts: then it was taken to another floor.
void PriorEstimator::State::continue_height(double vz_sigma_m_s) {
  VerticalFilter::Continuation from;
  from.z_m = resumed.height_m + above_base(p_base_imu);
  from.variance_m2 = resumed.variance_m2 + squared(kStandSigmaM);
  from.vz_sigma_m_s = vz_sigma_m_s;
  from.offset_m = resumed.offset_m;
  const double pause_s = seconds_between(resumed.stamp_ns, now_ns());
  const bool short_pause = is_short_pause(pause_s);
  if (short_pause) keep_climbing(pause_s, from);
  if (reading_source == HeightSource::kDifferential && !resumed.step_open) {
    const double lever_m = above_base(config.p_base_port - p_base_imu);
    const double risen_m = reading_m - lever_m - resumed.offset_m - from.z_m;
    if (short_pause) {
      use_unseen_climb(risen_m, from);
    } else if (std::abs(risen_m) > std::max(kMovedM, kMovedSigmas * std::sqrt(from.variance_m2))) {
      from.z_m += risen_m;
      from.variance_m2 += squared(kMovedSigmaM);
    }
  }
  height.resume(from);
}

void PriorEstimator::State::keep_climbing(double pause_s, VerticalFilter::Continuation& from) const {
  from.z_m += resumed.climb_m_s * pause_s;
  from.variance_m2 += squared(kUnseenClimbMS * pause_s);
  from.vz_m_s = resumed.climb_m_s;
  from.vz_sigma_m_s = std::max(from.vz_sigma_m_s, kUnseenClimbMS);
  // A robot that drives is not in an elevator; of one that stands nobody has seen whether a ride has begun.
  from.may_ride = resumed.ground_moves || wheels_stand();
}

bool PriorEstimator::State::wheels_stand() const {
  return wheels.valid(now_ns()) && std::hypot(wheels.last().vx_m_s, wheels.last().vy_m_s) < kStandMS;
}

// `risen_m`: height of the pressure above the predicted one. More than stairs explain is a ride that has begun or
// ended unseen.
void PriorEstimator::State::use_unseen_climb(double risen_m, VerticalFilter::Continuation& from) {
  if (std::abs(risen_m) > kRideM) {
    from.may_ride = true;
    from.variance_m2 += squared(risen_m);
  }
  if (from.may_ride) from.vz_sigma_m_s = kRideSigmaMS;
  const double gain = from.variance_m2 / (from.variance_m2 + squared(kPressureSigmaM));
  from.z_m += gain * risen_m;
  from.variance_m2 *= 1.0 - gain;
}

void PriorEstimator::State::bridge_gap(const Eigen::Vector3d& gyro, double dt_s) {
  // Trapezoid: the rate before the gap for its beginning, the rate after it for its end.
  const double edge_s = std::min(0.5 * dt_s, kConstantRateS);
  Eigen::Vector3d turn = (gyro_before + gyro - 2.0 * attitude.gyro_bias_rad_s()) * edge_s;
  if (wheels.valid(now_ns())) turn.z() += wheels.last().wz_rad_s * (dt_s - 2.0 * edge_s);
  attitude.bridge(turn, dt_s, std::min(kUnseenRateRadS * dt_s, kUnseenTurnRad));
  standstill.restart();
  noise.restart();
  height.bridge(dt_s);
}

void PriorEstimator::State::restart_clock(double dt_s) {
  yaw_before_rad = attitude.started() ? yaw_of(attitude.q_world_base()) : yaw_before_rad;
  attitude.stop();
  standstill.restart();
  noise.restart();
  altimeter.restart_clock();
  wheels = WheelOdometer(config.dead_reckoning);
  if (height.started()) height.bridge(dt_s);
  alignment.restart();
  device.restart();
}

void PriorEstimator::State::use_device_attitude(const ImuSample& sample, const Eigen::Vector3d& gyro,
                                                double dt_s) {
  if (!device.add(sample, gyro, attitude.gyro_bias_rad_s(), dt_s)) return;
  const DeviceAttitude::Update update = device.take();
  attitude.update_up_direction(update.up_base, update.interval_s);
  attitude.update_gyro_bias(update.gyro_bias_rad_s, kDeviceBiasSigmaRadS);
}

void PriorEstimator::State::use_standstill(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force,
                                           double dt_s, bool on_wheels) {
  const double bias_sigma = std::sqrt(std::max(
      {attitude.gyro_bias_variance(0), attitude.gyro_bias_variance(1), attitude.gyro_bias_variance(2)}));
  standstill.add_imu(gyro, attitude.gyro_bias_rad_s(), bias_sigma, force, dt_s);
  use_rest(on_wheels);
  // Zero-rate updates need wheels: a hanging platform may turn slowly and evenly, which the gyro alone cannot
  // tell from its bias.
  if (!standstill.take_window() || !on_wheels) return;
  attitude.update_zero_rate(standstill.mean_gyro_rad_s(), standstill.window_s(),
                            standstill.gyro_variance_of_mean());
}

void PriorEstimator::State::use_rest(bool on_wheels) {
  if (!standstill.resting()) rest_gravity.restart();
  StandstillDetector::Rest rest;
  if (!standstill.take_rest(rest)) return;
  RestGravity::Measurement measured;
  if (!rest_gravity.add(rest, on_wheels, measured)) return;
  attitude.update_rest(rest.force_m_s2, measured.variance);
  // On wheels a standstill measures all axes.
  if (!on_wheels) attitude.update_level_rate(rest.gyro_rad_s, measured.rate_variance);
}

void PriorEstimator::State::use_wheels(std::int64_t stamp_ns, double dt_s, bool on_wheels) {
  if (on_wheels && new_wheels) {
    const double wheel_dt_s =
        std::min(std::max(wheels.interval_s(), dt_s), config.dead_reckoning.wheel_timeout_s);
    const bool used = attitude.update_wheels(wheels.last(), wheel_dt_s, !height.ground_moves());
    slip.add_speed(used, wheel_dt_s);
    new_wheels = false;
  }
  since_bounded_s = on_wheels ? 0.0 : since_bounded_s + dt_s;
  if (since_bounded_s >= kBoundedUpdateS) {
    attitude.update_bounded_velocity(since_bounded_s);
    since_bounded_s = 0.0;
  }
  const Eigen::Vector2d rolled_m = wheels.take_displacement(stamp_ns);
  p_odom_base += midpoint_step(attitude.q_world_base(), attitude.rate_rad_s() * (-0.5 * dt_s),
                               {rolled_m.x(), rolled_m.y(), 0.0});
}

void PriorEstimator::State::watch_slip(double dt_s, bool comparable) {
  if (!comparable) {
    slip.restart();
    return;
  }
  slip.add_rates(attitude.rate_rad_s().z(), wheels.last().wz_rad_s, dt_s);
  const SlipWatch::Slip found = slip.take();
  counters.wheel_turn_slips += found.turn ? 1 : 0;
  counters.wheel_speed_slips += found.speed ? 1 : 0;
}

void PriorEstimator::State::use_climb(double dt_s, bool on_wheels, bool pressure_lost) {
  if (!on_wheels && !pressure_lost) {
    climb.restart();
    return;
  }
  if (on_wheels) {
    const Eigen::Vector3d v_base(wheels.last().vx_m_s, wheels.last().vy_m_s, 0.0);
    const Eigen::Vector3d v_imu = v_base + attitude.rate_rad_s().cross(p_base_imu);
    const Eigen::Vector3d forward = attitude.q_world_base() * Eigen::Vector3d::UnitX();
    climb.add(above_base(v_imu), v_base.x() * std::hypot(forward.x(), forward.y()), dt_s);
  } else {
    climb.add_time(dt_s);
  }
  if (!climb.due()) return;
  if (on_wheels) {
    height.update_climb(climb.climb_m_s(), climb.forward_m_s(), climb.elapsed_s(),
                        attitude.roll_pitch_variance_rad2());
  } else {
    height.update_bounded_speed(climb.elapsed_s());
  }
  climb.restart();
}

void PriorEstimator::State::step(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s,
                                 bool gap) {
  const std::int64_t stamp_ns = now_ns();
  const bool on_wheels = wheels.valid(stamp_ns);
  start_height();
  if (gap) {
    bridge_gap(gyro, dt_s);
  } else {
    noise.add_sample(gyro, force, dt_s);
    attitude.predict(gyro, force, dt_s, noise.gyro_variance(), noise.accel_variance());
    // Raw force, without the attitude filter's accelerometer bias, which still changes: the height filter
    // estimates its own.
    const double up_accel = above_base(force) - kGravity;
    up_accel_m_s2 = up_accel;
    noise.add_up_accel(up_accel);
    height.predict(up_accel, dt_s, noise.up_accel_density(dt_s));
    use_standstill(gyro, force, dt_s, on_wheels);
  }
  if (height.started()) climbed_m += std::clamp(height.vz_m_s(), -kFastestClimbMS, kFastestClimbMS) * dt_s;
  use_wheels(stamp_ns, dt_s, on_wheels);
  watch_slip(dt_s, on_wheels && !gap);
  const bool pressure_lost = altimeter.robot_lost(stamp_ns, config.height.barometer_timeout_s);
  if (!gap) use_climb(dt_s, on_wheels, pressure_lost);
}

}  // namespace isobar
