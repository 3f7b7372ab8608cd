// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/wheel_model.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::simulation {

WheelErrors WheelErrors::draw(Random random, bool tracked) {
  // Skid steering: Martinez et al. 2005, "Approximating kinematics for tracked mobile robots", find an
  // effective track width 1.3 to 1.7 times the real one, known to some per cent after calibration, and a few
  // per cent of slip. Tracks that climb steps lose up to a tenth of their motion.
  WheelErrors errors;
  if (!tracked) {
    // Tyres: Borenstein and Feng 1996, "Measurement and correction of systematic odometry errors": scale
    // errors of up to a per cent, slightly larger ones of wheelbase and steering, hardly any slip on asphalt.
    errors.scale = random.normal(0.005);
    errors.turn_scale = random.normal(0.015);
    errors.slip_sigma = random.uniform(0.002, 0.005);
    errors.turn_slip_sigma = random.uniform(0.01, 0.03);
    errors.noise_m_s = random.uniform(0.01, 0.03);
    errors.noise_rad_s = random.uniform(0.003, 0.01);
    return errors;
  }
  errors.scale = random.normal(0.01);
  errors.turn_scale = random.normal(0.06);
  errors.slip_sigma = random.uniform(0.01, 0.02);
  errors.stair_slip = random.uniform(0.03, 0.10);
  errors.turn_slip_sigma = random.uniform(0.03, 0.08);
  errors.noise_m_s = random.uniform(0.005, 0.015);
  errors.noise_rad_s = random.uniform(0.005, 0.02);
  return errors;
}

WheelModel::WheelModel(const Trajectory& trajectory, const WheelErrors& errors, Random random)
    : trajectory_(trajectory),
      errors_(errors),
      random_(random),
      slip_(errors.slip_sigma, 1.0, Random(random_.next())),
      turn_slip_(errors.turn_slip_sigma, 1.0, Random(random_.next())) {}

WheelSample WheelModel::sample(double time_s) {
  const MotionState state = trajectory_.at(time_s);
  const Eigen::Vector3d forward = state.q_world_base * Eigen::Vector3d::UnitX();
  const double v = state.v_world.dot(forward);
  const double tilt = std::asin(std::clamp(forward.z(), -1.0, 1.0));
  const double dt_s = 1.0 / kRateHz;
  double slip = slip_.step(dt_s);
  // Slip on stairs: the tracks run farther than the robot moves when climbing, and less far when descending.
  constexpr double kStairTiltRad = 0.15;
  if (std::abs(tilt) > kStairTiltRad) slip += std::copysign(errors_.stair_slip, tilt * v);
  // The encoders of a robot at rest read exactly zero, also while an elevator moves it.
  const Eigen::Vector2d flat_velocity = state.v_world.head<2>();
  const bool moves = flat_velocity.norm() > 0.002 || std::abs(state.w_base.z()) > 0.01;
  WheelSample sample;
  const double turn = turn_slip_.step(dt_s);
  const double noise_v = random_.normal(errors_.noise_m_s);
  const double noise_w = random_.normal(errors_.noise_rad_s);
  if (!moves) return sample;
  sample.vx_m_s = v * (1.0 + errors_.scale) * (1.0 + slip) + noise_v;
  sample.wz_rad_s = state.w_base.z() * (1.0 + errors_.turn_scale) * (1.0 + turn) + noise_w;
  return sample;
}

}  // namespace isobar::simulation
