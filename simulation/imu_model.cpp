// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/imu_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry.hpp"
#include "core/so3.hpp"

namespace isobar::simulation {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kWanderTauS = 200.0;  // a Gauss-Markov process approximates flicker noise over some minutes
// A cabin on its ropes: 0.02 to 0.035 m/s^2 rms at 1 to 2 m/s, measured by a phone on its floor; an oscillator of some
// hertz. Its displacement is bounded: unlike white noise it does not add up to a height.
constexpr double kCabinHz = 6.0;
constexpr double kCabinDamping = 0.2;
// Horizontal share of the speed below which the robot does not drive but is carried.
constexpr double kCarriedShare = 0.05;

Vector3d draw_vector(Random& random, double sigma) {
  const double x = random.normal(sigma);
  const double y = random.normal(sigma);
  const double z = random.normal(sigma);
  return {x, y, z};
}

/// Identity plus scale errors on the diagonal and misalignment angles off the diagonal.
Matrix3d draw_scale(Random& random, double scale_sigma, double angle_sigma_rad) {
  Matrix3d scale = Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) scale(i, j) += random.normal(i == j ? scale_sigma : angle_sigma_rad);
  }
  return scale;
}

}  // namespace

ImuErrors ImuErrors::draw(Random random, bool tracked) {
  ImuErrors errors;
  const bool xsens = random.chance(0.5);
  errors.model = xsens ? "MTi-10" : "VN-100";
  if (xsens) {
    // MTi 10-series data sheet: gyro 0.03 deg/s/rtHz, in-run 18 deg/h, turn-on 0.2 deg/s (1 sigma);
    // accelerometer 80 ug/rtHz, in-run 40 ug, turn-on 5 mg.
    errors.gyro_density_rad_s_rthz = 0.03 * kRadPerDeg;
    errors.gyro_bias_rad_s = draw_vector(random, 0.2 * kRadPerDeg);
    errors.gyro_instability_rad_s = 18.0 / 3600.0 * kRadPerDeg;
    errors.accel_density_m_s2_rthz = 80e-6 * kGravity;
    errors.accel_bias_m_s2 = draw_vector(random, 3e-3 * kGravity);
    errors.accel_instability_m_s2 = 40e-6 * kGravity;
  } else {
    // VN-100 data sheet: gyro 0.0035 deg/s/rtHz, in-run 5 to 10 deg/h; accelerometer 0.14 mg/rtHz, in-run
    // 0.04 mg; attitude 0.5 deg static, 1 deg dynamic.
    errors.gyro_density_rad_s_rthz = 0.0035 * kRadPerDeg;
    errors.gyro_bias_rad_s = draw_vector(random, 0.1 * kRadPerDeg);
    errors.gyro_instability_rad_s = 8.0 / 3600.0 * kRadPerDeg;
    errors.accel_density_m_s2_rthz = 140e-6 * kGravity;
    errors.accel_bias_m_s2 = draw_vector(random, 2e-3 * kGravity);
    errors.accel_instability_m_s2 = 40e-6 * kGravity;
    errors.has_attitude = true;
    errors.attitude_sigma_rad = 0.4 * kRadPerDeg;
  }
  // Both data sheets: 0.05 % of scale after calibration, 0.05 deg between axes.
  errors.gyro_scale = draw_scale(random, 5e-4, 0.05 * kRadPerDeg);
  errors.accel_scale = draw_scale(random, 5e-4, 0.05 * kRadPerDeg);
  if (tracked) {
    // Tracks on hard floor: some 0.1 m/s^2 and about 1 deg/s in a band of 100 Hz.
    errors.vibration_m_s2 = random.uniform(0.3, 0.6);
    errors.vibration_rad_s = random.uniform(0.01, 0.02);
    errors.cabin_vibration_m_s2 = random.uniform(0.02, 0.035);
  }
  return errors;
}

ImuModel::ImuModel(const Trajectory& trajectory, const Eigen::Isometry3d& T_base_imu, const ImuErrors& errors,
                   Random random)
    : trajectory_(trajectory),
      T_base_imu_(T_base_imu),
      errors_(errors),
      random_(random),
      cabin_random_(random.next(), "cabin") {
  gyro_wander_ = white(errors.gyro_instability_rad_s);
  accel_wander_ = white(errors.accel_instability_m_s2);
  attitude_wander_ = white(errors.attitude_sigma_rad);
}

Vector3d ImuModel::white(double sigma) {
  return sigma > 0.0 ? draw_vector(random_, sigma) : Vector3d(Vector3d::Zero());
}

void ImuModel::wander(Vector3d& bias, double sigma) {
  const double keep = std::exp(-1.0 / (kRateHz * kWanderTauS));
  bias = keep * bias + white(sigma * std::sqrt(1.0 - keep * keep));
}

// Vertical acceleration of a cabin's vibration while the cabin moves; it rings out after the stop.
double ImuModel::vibrate_cabin(double speed_m_s) {
  constexpr double kDtS = 1.0 / kRateHz;
  constexpr double kOmega = 2.0 * std::numbers::pi * kCabinHz;
  // Variance of the acceleration: that of a white drive, and w dt / 4 z times that of the oscillator's answer.
  constexpr double kAnswer = kOmega * kDtS / (4.0 * kCabinDamping);
  const double drive_m_s2 =
      std::min(1.0, speed_m_s) * errors_.cabin_vibration_m_s2 / std::sqrt(1.0 + kAnswer);
  const double before_m_s = cabin_m_s_;
  cabin_m_s_ += kDtS * (cabin_random_.normal(drive_m_s2) - 2.0 * kCabinDamping * kOmega * cabin_m_s_ -
                        kOmega * kOmega * cabin_m_);
  cabin_m_ += kDtS * cabin_m_s_;
  return (cabin_m_s_ - before_m_s) / kDtS;
}

ImuSample ImuModel::sample(double time_s) {
  const MotionState state = trajectory_.at(time_s);
  const Matrix3d R_world_base = state.q_world_base.toRotationMatrix();
  const double speed = state.v_world.norm();
  const bool carried = state.v_world.head<2>().norm() < kCarriedShare * speed;
  const double cabin_m_s2 = vibrate_cabin(carried ? speed : 0.0);
  const Vector3d lever = T_base_imu_.translation();
  // Acceleration of a point r of a rigid body: a + w' x r + w x (w x r).
  const Vector3d a_base =
      R_world_base.transpose() * (state.a_world + Vector3d(0.0, 0.0, kGravity + cabin_m_s2)) +
      state.wdot_base.cross(lever) + state.w_base.cross(state.w_base.cross(lever));
  const Matrix3d R_imu_base = T_base_imu_.rotation().transpose();
  wander(gyro_wander_, errors_.gyro_instability_rad_s);
  wander(accel_wander_, errors_.accel_instability_m_s2);
  wander(attitude_wander_, errors_.attitude_sigma_rad);
  const bool on_slope = std::abs(state.v_world.z()) > 0.1 * speed;
  const double shaking = carried ? 0.0 : std::min(1.0, speed / 0.6) * (on_slope ? 2.0 : 1.0);
  // White noise of density n sampled at rate f has standard deviation n sqrt(f / 2).
  const double band = std::sqrt(0.5 * kRateHz);
  ImuSample sample;
  sample.gyro_rad_s = errors_.gyro_scale * (R_imu_base * state.w_base) + errors_.gyro_bias_rad_s +
                      gyro_wander_ + white(errors_.gyro_density_rad_s_rthz * band) +
                      white(shaking * errors_.vibration_rad_s);
  sample.accel_m_s2 = errors_.accel_scale * (R_imu_base * a_base) + errors_.accel_bias_m_s2 + accel_wander_ +
                      white(errors_.accel_density_m_s2_rthz * band) + white(shaking * errors_.vibration_m_s2);
  if (errors_.has_attitude) {
    sample.has_attitude = true;
    sample.q_world_imu = (rotation_from_rpy(attitude_wander_) * state.q_world_base *
                          Eigen::Quaterniond(T_base_imu_.rotation()))
                             .normalized();
  }
  return sample;
}

}  // namespace isobar::simulation
