// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/pose_carrying.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Upper bound of the predicted error of a lost robot: beyond it the search would cover everything.
constexpr double kLargestDeviationM = 2.0;
constexpr double kLargestDeviationRad = 0.5;
// Gain of the velocity's alpha filter, horizontal and vertical. A gain of 0.5 follows a platform swinging on
// a rope and halves the noise.
constexpr double kVelocityGain = 0.5;
constexpr double kVerticalVelocityGain = 0.3;
// Registrations further apart give no velocity: between them it has changed.
constexpr double kLongestVelocityStepS = 0.5;
// Speed of a robot without wheels whose run begins in motion [m/s], 1 sigma, and the number of registered scans from
// which it is known. With the error of a known velocity the first scans were laid onto each other as if the robot stood:
// outdoors 13 m of 62 were lost, along a corridor 0.5 m.
constexpr double kUnknownSpeedMS = 5.0;
constexpr int kScansToVelocity = 4;
// Step of a pose that is held: the velocity is known, it is zero [m].
constexpr double kStoodM = 1e-4;
// Smallest error of a step without wheels: the error of a velocity from registrations.
constexpr double kFreeMotionFloorM = 0.02;
// Doubt about gravity's offset beyond which the map stays rigid, so that it does not hide the offset [rad].
constexpr double kKnownOffsetRad = 0.1 * kRadPerDeg;
// Turn rate of a robot whose IMU is silent, 1 sigma.
constexpr double kUnseenRateRadS = 0.5;

// Fuses the predicted roll and pitch with gravity's, of standard deviation `sigma_rad`: the weighted mean of
// the two directions of up, and its variance.
void pull_to_gravity(const Eigen::Vector3d& up_base, double sigma_rad, Prediction& prediction) {
  Eigen::Matrix3d R_map_base = prediction.T_map_base.linear();
  const Eigen::Vector3d tilt = (R_map_base * up_base).cross(Eigen::Vector3d::UnitZ());
  const double motion_variance = prediction.deviation(0) * prediction.deviation(0);
  const double gravity_variance = sigma_rad * sigma_rad;
  const double weight = motion_variance / (motion_variance + gravity_variance);
  R_map_base = exp_so3(weight * tilt).toRotationMatrix() * R_map_base;
  prediction.T_map_base.linear() = Eigen::Quaterniond(R_map_base).normalized().toRotationMatrix();
  prediction.deviation.head<2>().setConstant(std::sqrt(weight * gravity_variance));
}

// Sources of the components of a prediction.
std::array<Holder, 6> holders_of(const MethodTraits& method, bool followed, bool on_wheels) {
  const Holder turn = followed ? Holder::kGyro : Holder::kMotion;
  const Holder tilt = method.tilt != Constraint::kFree && followed ? Holder::kGravityDirection : turn;
  const Holder way = on_wheels ? Holder::kWheels : Holder::kMotion;
  return {tilt, tilt, turn, way, way, method.follows_altimeter() ? Holder::kAltimeter : way};
}

double non_negative_root(double x) { return std::sqrt(std::max(x, 0.0)); }

}  // namespace

double gravity_sigma_rad(double known_rad, double offset_sigma_rad) {
  return std::hypot(known_rad, offset_sigma_rad * std::pow(offset_sigma_rad / kKnownOffsetRad, 2));
}

void MotionModel::start(const Prior& prior, const Eigen::Vector3d& offset_rad) {
  const Eigen::Matrix3d R = prior.T_odom_base.linear() * exp_so3(-offset_rad).toRotationMatrix();
  T_map_base_.setIdentity();
  T_map_base_.linear() = rotation_about_z(-yaw_of(R)) * R;
  T_map_base_.translation().z() = prior.height_source == HeightSource::kNone ? 0.0 : prior.height_m;
  started_ = true;
  lift_m_ = 0.0;
  last_ = prior;
  v_map_m_s_.setZero();
  w_base_rad_s_.setZero();
  registered_ = 0;
  confirmed_ns_ = prior.stamp_ns;
  unconfirmed_m_ = 0.0;
}

void MotionModel::start_at(const Prior& prior, const Eigen::Isometry3d& T_map_base) {
  start(prior);
  const Eigen::Matrix3d& R = T_map_base.linear();
  T_map_base_.linear() = rotation_about_z(yaw_of(R)) * T_map_base_.linear();
  T_map_base_.translation() = T_map_base.translation();
}

void MotionModel::take_over(const MotionModel& other) {
  const RegistrationConfig own = config_;
  *this = other;
  config_ = own;
}

void MotionModel::relocate(const Prior& now, const Eigen::Isometry3d& T_map_base) {
  last_ = now;
  T_map_base_ = T_map_base;
  v_map_m_s_.setZero();
  w_base_rad_s_.setZero();
  confirmed_ns_ = now.stamp_ns;
  unconfirmed_m_ = 0.0;
}

void MotionModel::follow_map(const Eigen::Isometry3d& T_now_before) {
  T_map_base_ = T_now_before * T_map_base_;
  lift_m_ += T_now_before.translation().z();
  v_map_m_s_ = T_now_before.linear() * v_map_m_s_;
}

double MotionModel::travel_s(const Prior& now) const {
  return std::max(0.0, seconds_between(last_.stamp_ns, now.stamp_ns));
}

double MotionModel::since_confirmed_s(std::int64_t stamp_ns) const {
  return std::max(0.0, seconds_between(confirmed_ns_, stamp_ns));
}

Eigen::Vector3d MotionModel::velocity_at(std::int64_t stamp_ns) const {
  return v_map_m_s_ * std::exp(-since_confirmed_s(stamp_ns) / config_.velocity_memory_s);
}

Eigen::Vector3d MotionModel::step_at_velocity_map(const Prior& now) const {
  // Integral of the decaying velocity from the last scan to now.
  const double tau = config_.velocity_memory_s;
  return velocity_at(last_.stamp_ns) * tau * (1.0 - std::exp(-travel_s(now) / tau));
}

Eigen::Vector3d MotionModel::turn_rate_at(std::int64_t stamp_ns) const {
  return w_base_rad_s_ * std::exp(-since_confirmed_s(stamp_ns) / config_.velocity_memory_s);
}

// By the gyro, or by wheels without one.
bool MotionModel::turn_known(const Prior& now) const { return followed(now) || on_wheels(now); }

Prediction MotionModel::predict(const Prior& now, const MethodTraits& method,
                                const GravityOffset& offset) const {
  const bool by_gyro = followed(now);
  const bool by_wheels = on_wheels(now);
  const Eigen::Isometry3d& T_odom_before = turn_known(now) ? last_.T_odom_base : now.T_odom_base;
  const PoseAnchor anchor(T_map_base_, T_odom_before);
  const Eigen::Matrix3d R_map_odom =
      method.tilt == Constraint::kFixed ? nearest_rotation_about_z(anchor.R_map_odom()) : anchor.R_map_odom();
  const Eigen::Vector3d step_map_m =
      by_wheels ? anchor.step_map_m(now.T_odom_base) : step_at_velocity_map(now);

  Prediction prediction;
  prediction.T_map_base.linear() =
      Eigen::Quaterniond(R_map_odom * now.T_odom_base.linear()).normalized().toRotationMatrix();
  prediction.T_map_base.translation() = T_map_base_.translation() + step_map_m;
  if (method.follows_altimeter()) {
    prediction.T_map_base.translation().z() = now.height_m + lift_m_;
  }
  if (!turn_known(now)) turn_on(now, prediction);
  const double dt_s = std::max(travel_s(now), seconds_between(confirmed_ns_, now.stamp_ns));
  const double turn_rad =
      rotation_angle_rad(Eigen::Quaterniond(T_odom_before.linear().transpose() * now.T_odom_base.linear()));
  const double rate_rad_s = non_negative_root(now.yaw_rate_variance_rad2_s2);
  const auto error_rad = [&](double rate) {
    return std::min(rotation_error_rad(turn_rad, rate, dt_s), kLargestDeviationRad);
  };
  const double translation_m = by_wheels ? wheel_error_m(now, step_map_m.norm(), dt_s) : free_error_m(dt_s);
  prediction.deviation.head<3>().setConstant(
      error_rad(by_gyro ? rate_rad_s : std::max(rate_rad_s, kUnseenRateRadS)));
  // Wheels know yaw alone.
  if (by_wheels && !by_gyro) prediction.deviation(2) = error_rad(rate_rad_s);
  prediction.deviation.tail<3>().setConstant(std::min(translation_m, kLargestDeviationM));
  prediction.deviation.segment<2>(3).setConstant(std::max(prediction.deviation(3), start_error_m(now)));
  if (method.follows_altimeter()) {
    prediction.deviation(5) = config_.altitude_prior_error_m;
  }
  if (method.tilt == Constraint::kSoft && now.attitude_valid) {
    const Eigen::Vector3d up_base = exp_so3(offset.offset_rad) * now.T_odom_base.linear().row(2).transpose();
    pull_to_gravity(up_base, gravity_sigma_rad(config_.gravity_error_deg * kRadPerDeg, offset.sigma_rad),
                    prediction);
  }
  prediction.T_map_odom = prediction.T_map_base * now.T_odom_base.inverse();
  prediction.holders = holders_of(method, by_gyro, by_wheels);
  return prediction;
}

// Neither gyro nor wheels: the turn of the last registrations goes on.
void MotionModel::turn_on(const Prior& now, Prediction& prediction) const {
  const Eigen::Vector3d turn_rad = turn_rate_at(last_.stamp_ns) * travel_s(now);
  const Eigen::Quaterniond q_map_base(prediction.T_map_base.linear());
  prediction.T_map_base.linear() = (q_map_base * exp_so3(turn_rad)).normalized().toRotationMatrix();
}

double MotionModel::wheel_error_m(const Prior& now, double step_m, double dt_s) const {
  const double way_m = unconfirmed_m_ + step_m;
  const double speed_error_m_s = now.standing_still ? 0.0 : non_negative_root(now.velocity_variance_m2_s2);
  return config_.step_translation_floor_m + (speed_error_m_s * dt_s + config_.step_distance_error * way_m);
}

double MotionModel::free_error_m(double dt_s) const {
  return config_.step_translation_floor_m +
         (kFreeMotionFloorM + 0.5 * config_.free_acceleration_m_s2 * dt_s * dt_s);
}

bool MotionModel::speed_unknown(const Prior& now) const {
  return registered_ < kScansToVelocity && !on_wheels(now) && !now.standing_still;
}

// Horizontal error of a step while the velocity of the start is unknown.
double MotionModel::start_error_m(const Prior& now) const {
  return speed_unknown(now) ? std::min(kUnknownSpeedMS * travel_s(now), kLargestDeviationM) : 0.0;
}

double MotionModel::rotation_error_rad(double turn_rad, double rate_rad_s, double dt_s) const {
  return config_.step_rotation_floor_deg * kRadPerDeg + config_.step_rotation_share * turn_rad +
         rate_rad_s * dt_s;
}

MotionModel::Twist MotionModel::twist_to(const Eigen::Isometry3d& T_map_base, double dt_s) const {
  return {(T_map_base.translation() - T_map_base_.translation()) / dt_s,
          log_so3(Eigen::Quaterniond(T_map_base_.linear().transpose() * T_map_base.linear())) / dt_s};
}

void MotionModel::correct(const Prior& now, const Eigen::Isometry3d& T_map_base) {
  const double dt_s = travel_s(now);
  if (dt_s > 1e-3 && dt_s < kLongestVelocityStepS) {
    const Twist measured = twist_to(T_map_base, dt_s);
    const Eigen::Vector3d gain = registered_ == 0
                                     ? Eigen::Vector3d(1.0, 1.0, kVerticalVelocityGain)
                                     : Eigen::Vector3d(kVelocityGain, kVelocityGain, kVerticalVelocityGain);
    v_map_m_s_ += gain.cwiseProduct(measured.v_map_m_s - v_map_m_s_);
    w_base_rad_s_ = measured.w_base_rad_s;
  } else {
    v_map_m_s_.setZero();
    w_base_rad_s_.setZero();
  }
  const bool stood = (T_map_base.translation() - T_map_base_.translation()).norm() < kStoodM;
  registered_ = stood ? std::max(registered_ + 1, kScansToVelocity) : registered_ + 1;
  last_ = now;
  T_map_base_ = T_map_base;
  confirmed_ns_ = now.stamp_ns;
  unconfirmed_m_ = 0.0;
}

void MotionModel::turn_base(const Eigen::Matrix3d& R) {
  T_map_base_.linear() =
      Eigen::Quaterniond(T_map_base_.linear() * R.transpose()).normalized().toRotationMatrix();
}

void MotionModel::keep_prediction(const Prior& now, const Prediction& prediction) {
  unconfirmed_m_ += (prediction.T_map_base.translation() - T_map_base_.translation()).norm();
  T_map_base_ = prediction.T_map_base;
  last_ = now;
}

ScanMotion MotionModel::motion_towards(const Prior& end, const Eigen::Isometry3d& T_map_base) const {
  // The mean of what was predicted and what is shown: undamped, steps of a robot that turns swing by half of them.
  constexpr double kShare = 0.5;
  const Twist shown = twist_to(T_map_base, std::max(travel_s(end), 1e-3));
  ScanMotion motion;
  motion.end = end;
  motion.from_wheels = motion.turn_known = false;
  motion.v_base_m_s = T_map_base.linear().transpose() *
                      (kShare * shown.v_map_m_s + (1.0 - kShare) * velocity_at(end.stamp_ns));
  motion.w_base_rad_s = kShare * shown.w_base_rad_s + (1.0 - kShare) * turn_rate_at(end.stamp_ns);
  return motion;
}

ScanMotion MotionModel::scan_motion(const Prior& end, const Prediction& prediction) const {
  ScanMotion motion;
  motion.end = end;
  motion.from_wheels = end.velocity_valid;
  motion.turn_known = end.attitude_valid || end.velocity_valid;
  motion.w_base_rad_s = turn_rate_at(end.stamp_ns);
  motion.v_base_m_s = prediction.T_map_base.linear().transpose() * velocity_at(end.stamp_ns);
  return motion;
}

}  // namespace isobar
