// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// What a lost robot may be off by at most: beyond this the search would cover everything.
constexpr double kLargestDeviationM = 2.0;
constexpr double kLargestDeviationRad = 0.5;
// Share of a velocity's surprise that is believed. Half follows a swinging rope and halves the noise.
constexpr double kVelocityGain = 0.5;
constexpr double kVerticalVelocityGain = 0.3;
constexpr double kLongestVelocityStepS = 0.5;
constexpr double kFreeMotionFloorM = 0.02;
// How fast a robot turns of which the IMU says nothing, 1 sigma [rad/s].
constexpr double kUnseenRateRadS = 0.5;

}  // namespace

Eigen::Matrix3d yaw_only(const Eigen::Matrix3d& rotation) {
  // Maximises the trace of yaw^T rotation.
  const double yaw = std::atan2(rotation(1, 0) - rotation(0, 1), rotation(0, 0) + rotation(1, 1));
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

void MotionModel::start(const Prior& prior) {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d& R = prior.T_odom_base.linear();
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  T_map_base.linear() = Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()) * R;
  T_map_base.translation().z() = prior.height_source == HeightSource::kNone ? 0.0 : prior.height_m;
  start_at(prior, T_map_base);
}

void MotionModel::start_at(const Prior& prior, const Eigen::Isometry3d& T_map_base) {
  started_ = true;
  last_ = prior;
  T_map_base_ = T_map_base;
  v_map_m_s_.setZero();
  confirmed_ns_ = prior.stamp_ns;
  unconfirmed_m_ = 0.0;
}

double MotionModel::travel_s(const Prior& now) const {
  return std::max(0.0, seconds_between(last_.stamp_ns, now.stamp_ns));
}

Eigen::Vector3d MotionModel::velocity_at(double since_s) const {
  return v_map_m_s_ * std::exp(-since_s / config_.velocity_memory_s);
}

Eigen::Vector3d MotionModel::translation_step_map(const Prior& now) const {
  if (now.velocity_valid && last_.velocity_valid) {
    const Eigen::Matrix3d R_map_odom = T_map_base_.linear() * last_.T_odom_base.linear().transpose();
    return R_map_odom * (now.T_odom_base.translation() - last_.T_odom_base.translation());
  }
  // The velocity dies away: its integral from the last confirmed scan on.
  const double dt = travel_s(now);
  const double tau = config_.velocity_memory_s;
  const double since = std::max(0.0, seconds_between(confirmed_ns_, last_.stamp_ns));
  return velocity_at(since) * tau * (1.0 - std::exp(-dt / tau));
}

Prediction MotionModel::predict(const Prior& now, const MethodTraits& method) const {
  Prediction prediction;
  // Between priors of which one is unknown there is no turn: the scan finds it.
  const bool followed = now.attitude_valid && last_.attitude_valid;
  const Eigen::Matrix3d& R_odom_base = followed ? last_.T_odom_base.linear() : now.T_odom_base.linear();
  const Eigen::Matrix3d R_map_odom_full = T_map_base_.linear() * R_odom_base.transpose();
  const Eigen::Matrix3d R_map_odom =
      method.attitude_from_gravity ? yaw_only(R_map_odom_full) : R_map_odom_full;
  const Eigen::Vector3d step = translation_step_map(now);
  prediction.T_map_base.linear() =
      Eigen::Quaterniond(R_map_odom * now.T_odom_base.linear()).normalized().toRotationMatrix();
  prediction.T_map_base.translation() = T_map_base_.translation() + step;
  if (method.z_prediction == ZPrediction::kAltimeter) {
    prediction.T_map_base.translation().z() = now.height_m;
  }
  prediction.T_map_odom = prediction.T_map_base * now.T_odom_base.inverse();

  const double dt = std::max(travel_s(now), seconds_between(confirmed_ns_, now.stamp_ns));
  double translation = config_.step_translation_floor_m;
  if (now.velocity_valid && last_.velocity_valid) {
    const double way = unconfirmed_m_ + step.norm();
    const double rate = now.standing_still ? 0.0 : std::sqrt(std::max(now.velocity_variance_m2_s2, 0.0));
    translation += rate * dt + config_.step_distance_error * way;
  } else {
    translation += kFreeMotionFloorM + 0.5 * config_.free_acceleration_m_s2 * dt * dt;
  }
  const double turn = Eigen::AngleAxisd(R_odom_base.transpose() * now.T_odom_base.linear()).angle();
  const double rate_error =
      std::max(std::sqrt(std::max(now.yaw_rate_variance_rad2_s2, 0.0)), followed ? 0.0 : kUnseenRateRadS);
  const double rotation =
      config_.step_rotation_floor_deg * kRadPerDeg + config_.step_rotation_share * turn + rate_error * dt;
  prediction.deviation.head<3>().setConstant(std::min(rotation, kLargestDeviationRad));
  prediction.deviation.tail<3>().setConstant(std::min(translation, kLargestDeviationM));
  if (method.z_prediction == ZPrediction::kAltimeter) {
    prediction.deviation(5) = config_.altitude_prior_error_m;
  }
  return prediction;
}

void MotionModel::correct(const Prior& now, const Eigen::Isometry3d& T_map_base) {
  const double dt = travel_s(now);
  if (dt > 1e-3 && dt < kLongestVelocityStepS) {
    const Eigen::Vector3d measured = (T_map_base.translation() - T_map_base_.translation()) / dt;
    const Eigen::Vector3d gain(kVelocityGain, kVelocityGain, kVerticalVelocityGain);
    v_map_m_s_ += gain.cwiseProduct(measured - v_map_m_s_);
  } else {
    v_map_m_s_.setZero();
  }
  last_ = now;
  T_map_base_ = T_map_base;
  confirmed_ns_ = now.stamp_ns;
  unconfirmed_m_ = 0.0;
}

void MotionModel::keep_prediction(const Prior& now, const Prediction& prediction) {
  unconfirmed_m_ += (prediction.T_map_base.translation() - T_map_base_.translation()).norm();
  T_map_base_ = prediction.T_map_base;
  last_ = now;
}

ScanMotion MotionModel::scan_motion(const Prior& end, const Prediction& prediction) const {
  ScanMotion motion;
  motion.end = end;
  motion.from_wheels = end.velocity_valid;
  const double since = std::max(0.0, seconds_between(confirmed_ns_, end.stamp_ns));
  motion.v_base_m_s = prediction.T_map_base.linear().transpose() * velocity_at(since);
  return motion;
}

}  // namespace isobar
