// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/trajectory.hpp"

#include <cmath>

#include "core/so3.hpp"

namespace isobar::simulation {

using Eigen::Vector3d;

namespace {

template <typename Get>
Channel channel(const std::vector<RawPose>& raw, Get get) {
  std::vector<double> samples;
  samples.reserve(raw.size());
  for (const RawPose& pose : raw) samples.push_back(get(pose));
  return Channel(std::move(samples));
}

/// Sets attitude, body rates and their derivative from roll, pitch, yaw (rotation z-y-x) and their first two
/// derivatives. Body rates from Euler rates: Diebel, "Representing Attitude" (2006), eq. 60.
void set_attitude(MotionState& state, const Vector3d& rpy, const Vector3d& rate, const Vector3d& curve) {
  state.q_world_base = rotation_from_rpy(rpy);
  const double sr = std::sin(rpy.x());
  const double cr = std::cos(rpy.x());
  const double sp = std::sin(rpy.y());
  const double cp = std::cos(rpy.y());
  const double r = rate.x();
  const double p = rate.y();
  const double y = rate.z();
  state.w_base = {r - sp * y, cr * p + sr * cp * y, -sr * p + cr * cp * y};
  state.wdot_base = {curve.x() - sp * curve.z() - cp * p * y,
                     cr * curve.y() + sr * cp * curve.z() - sr * r * p + (cr * r * cp - sr * sp * p) * y,
                     -sr * curve.y() + cr * cp * curve.z() - cr * r * p - (sr * r * cp + cr * sp * p) * y};
}

}  // namespace

Trajectory::Trajectory(const std::vector<RawPose>& raw)
    : x_(channel(raw, [](const RawPose& pose) { return pose.x_m; })),
      y_(channel(raw, [](const RawPose& pose) { return pose.y_m; })),
      z_(channel(raw, [](const RawPose& pose) { return pose.z_m; })),
      yaw_(channel(raw, [](const RawPose& pose) { return pose.yaw_rad; })),
      pitch_(channel(raw, [](const RawPose& pose) { return pose.pitch_rad; })),
      roll_(channel(raw, [](const RawPose& pose) { return pose.roll_rad; })) {}

double Trajectory::duration_s() const { return SplineGrid::kStepS * (static_cast<double>(x_.size()) - 1.0); }

MotionState Trajectory::at(double time_s) const {
  const SplineWeights weights = SplineGrid::weights(time_s, x_.size());
  MotionState state;
  state.p_world = {x_.value(weights), y_.value(weights), z_.value(weights)};
  state.v_world = {x_.rate(weights), y_.rate(weights), z_.rate(weights)};
  state.a_world = {x_.curve(weights), y_.curve(weights), z_.curve(weights)};
  set_attitude(state, {roll_.value(weights), pitch_.value(weights), yaw_.value(weights)},
               {roll_.rate(weights), pitch_.rate(weights), yaw_.rate(weights)},
               {roll_.curve(weights), pitch_.curve(weights), yaw_.curve(weights)});
  return state;
}

}  // namespace isobar::simulation
