// SPDX-License-Identifier: BSD-3-Clause
// How inertial samples and wheels move the state of the prior stage.
#include <algorithm>
#include <cmath>

#include "core/prior/prior_state.hpp"
#include "core/prior/rotation.hpp"

namespace isobar {
namespace {

// Bounded-velocity updates of a platform without wheels come this often.
constexpr double kBoundedUpdateS = 0.1;
// Wheels constrain the climb this often at most: their error is correlated over seconds anyway.
constexpr double kClimbUpdateS = 0.04;
// Up to this long a constant rate bridges a gap of the IMU; beyond, only the wheels' turn rate is believed.
constexpr double kConstantRateS = 0.3;
// What a robot may have turned unseen, 1 sigma [rad/s], at most [rad].
constexpr double kUnseenRate = 0.2;
constexpr double kUnseenTurn = 0.3;
// Roll and pitch from the first accelerations of a robot that may be moving [rad].
constexpr double kStartSigmaRad = 0.02;
// A robot's mean specific force over the start is gravity within a third: anything else is another unit (g)
// or a broken sensor, and would put the map on its side.
constexpr double kLeastGravity = 6.5;
constexpr double kMostGravity = 13.0;
// Vertical speed at the start of a platform on wheels, and of one that hangs [m/s].
constexpr double kStartClimbOnWheels = 0.05;
constexpr double kStartClimbHanging = 0.3;
// The attitude of the IMU's own filter as a rate is believed within this of the gyro [rad/s].
constexpr double kDeviceRateTolerance = 0.1;
constexpr double kDeviceRateSigma = 0.01;
constexpr double kQuaternionTolerance = 0.05;

}  // namespace

void PriorEstimator::State::align(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s) {
  const Eigen::Vector3d turn = (gyro - attitude.gyro_bias_rad_s()) * dt_s;
  start_force_sum = rotation_of(turn).conjugate() * start_force_sum + force;
  start_elapsed_s += dt_s;
  ++start_samples;
  if (start_elapsed_s < config.attitude.start_time_s) return;
  const double mean_force_m_s2 = start_force_sum.norm() / start_samples;
  if (mean_force_m_s2 < kLeastGravity || mean_force_m_s2 > kMostGravity) {
    ++counters.imu_wrong_gravity;
    restart_alignment();
    return;
  }
  attitude.start(start_force_sum, yaw_before_rad, kStartSigmaRad);
  restart_alignment();
  const bool on_wheels = wheels.valid(imu_gate.stamp_ns());
  if (!height.started()) {
    height_start_ns = imu_gate.stamp_ns();
    height.start(above_base(p_base_imu), on_wheels ? kStartClimbOnWheels : kStartClimbHanging);
  }
}

void PriorEstimator::State::restart_alignment() {
  start_force_sum.setZero();
  start_elapsed_s = 0.0;
  start_samples = 0;
}

void PriorEstimator::State::bridge_gap(const Eigen::Vector3d& gyro, double dt_s) {
  // The rate before holds for the beginning, the rate now for the end; between them the wheels' turn rate, if
  // any.
  const double edge_s = std::min(0.5 * dt_s, kConstantRateS);
  Eigen::Vector3d turn = (gyro_before + gyro - 2.0 * attitude.gyro_bias_rad_s()) * edge_s;
  if (wheels.valid(imu_gate.stamp_ns())) turn.z() += wheels.last().wz_rad_s * (dt_s - 2.0 * edge_s);
  attitude.bridge(turn, dt_s, std::min(kUnseenRate * dt_s, kUnseenTurn));
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
  restart_alignment();
  has_device_before = false;
}

void PriorEstimator::State::use_device_attitude(const ImuSample& sample, const Eigen::Vector3d& gyro,
                                                double dt_s) {
  const bool usable = config.attitude.use_imu_attitude && sample.has_attitude &&
                      std::abs(sample.q_world_imu.norm() - 1.0) <= kQuaternionTolerance;
  if (!usable) {
    has_device_before = false;
    return;
  }
  const Eigen::Quaterniond q_device = (sample.q_world_imu.normalized() * q_base_imu.conjugate()).normalized();
  if (has_device_before) {
    const Eigen::Vector3d rate = angle_of(q_device_before.conjugate() * q_device) / dt_s;
    if ((rate - gyro + attitude.gyro_bias_rad_s()).cwiseAbs().maxCoeff() < kDeviceRateTolerance) {
      device_bias_sum += (gyro - rate) * dt_s;
      since_device_s += dt_s;
    }
  }
  q_device_before = q_device;
  has_device_before = true;
  if (since_device_s < kBoundedUpdateS) return;
  attitude.update_up_direction(q_device.conjugate() * Eigen::Vector3d::UnitZ(), since_device_s);
  attitude.update_gyro_bias(device_bias_sum / since_device_s, kDeviceRateSigma);
  device_bias_sum.setZero();
  since_device_s = 0.0;
}

void PriorEstimator::State::use_standstill(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force,
                                           double dt_s, bool on_wheels) {
  const double bias_sigma = std::sqrt(std::max(
      {attitude.gyro_bias_variance(0), attitude.gyro_bias_variance(1), attitude.gyro_bias_variance(2)}));
  standstill.add_imu(gyro, attitude.gyro_bias_rad_s(), bias_sigma, force, dt_s);
  // A hanging platform that seems to stand may turn slowly and evenly: without wheels the gyro is not its own
  // witness.
  if (!standstill.take_window() || !on_wheels) return;
  attitude.update_zero_rate(standstill.mean_gyro(), standstill.window_s(),
                            standstill.gyro_variance_of_mean());
}

void PriorEstimator::State::use_wheels(std::int64_t stamp_ns, double dt_s, bool on_wheels) {
  if (on_wheels && new_wheels) {
    const double wheel_dt_s = std::max(wheels.interval_s(), dt_s);
    attitude.update_wheels(wheels.last().vx_m_s, wheels.last().vy_m_s,
                           std::min(wheel_dt_s, config.dead_reckoning.wheel_timeout_s),
                           !height.ground_moves());
    new_wheels = false;
  }
  since_bounded_s = on_wheels ? 0.0 : since_bounded_s + dt_s;
  if (since_bounded_s >= kBoundedUpdateS) {
    attitude.update_bounded_velocity(since_bounded_s);
    since_bounded_s = 0.0;
  }
  const Eigen::Vector2d rolled = wheels.take_displacement(stamp_ns);
  const Eigen::Quaterniond half_back = rotation_of(attitude.rate_rad_s() * (-0.5 * dt_s));
  p_odom_base += attitude.q_world_base() * half_back * Eigen::Vector3d(rolled.x(), rolled.y(), 0.0);
}

void PriorEstimator::State::use_climb(double dt_s, bool on_wheels, bool pressure_lost) {
  if (!on_wheels && !pressure_lost) {
    since_climb_s = climb_integral_m = forward_integral_m = 0.0;
    return;
  }
  since_climb_s += dt_s;
  if (on_wheels) {
    const Eigen::Vector3d v_base(wheels.last().vx_m_s, wheels.last().vy_m_s, 0.0);
    const Eigen::Vector3d v_imu = v_base + attitude.rate_rad_s().cross(p_base_imu);
    const Eigen::Vector3d forward = attitude.q_world_base() * Eigen::Vector3d::UnitX();
    climb_integral_m += above_base(v_imu) * dt_s;
    forward_integral_m += v_base.x() * std::hypot(forward.x(), forward.y()) * dt_s;
  }
  if (since_climb_s < kClimbUpdateS) return;
  if (on_wheels) {
    height.update_climb(climb_integral_m / since_climb_s, forward_integral_m / since_climb_s, since_climb_s,
                        attitude.roll_pitch_variance_rad2());
  } else {
    height.update_bounded_speed(since_climb_s);
  }
  since_climb_s = climb_integral_m = forward_integral_m = 0.0;
}

void PriorEstimator::State::move(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s,
                                 bool gap) {
  const std::int64_t stamp_ns = imu_gate.stamp_ns();
  const bool on_wheels = wheels.valid(stamp_ns);
  if (gap) {
    bridge_gap(gyro, dt_s);
  } else {
    noise.add_sample(gyro, force, dt_s);
    attitude.predict(gyro, force, dt_s, noise.gyro_variance(), noise.accel_variance());
    // Without the attitude filter's accelerometer bias, which still moves: the height filter has its own.
    const double up_accel = above_base(force) - kGravity;
    noise.add_up_accel(up_accel);
    height.predict(up_accel, dt_s, noise.up_accel_density(dt_s));
    use_standstill(gyro, force, dt_s, on_wheels);
  }
  use_wheels(stamp_ns, dt_s, on_wheels);
  const bool pressure_lost = altimeter.robot_lost(stamp_ns, config.height.barometer_timeout_s);
  if (!gap) use_climb(dt_s, on_wheels, pressure_lost);
}

}  // namespace isobar
