// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that says how far a pose may be off, in the frame of the map, whose origin is the start:
//
//     pose = scan against the map  +  map against the start  +  dead reckoning since the last scan  +  mounts
//            (ICP)                    (MapDrift, MapHeight)     (DeadReckoningError)
//
// in directions that gravity or the altimeter fix, their error instead.
#include <algorithm>
#include <cmath>

#include "core/registration/halt.hpp"
#include "core/registration/registration.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Floor of reported variances [m^2, rad^2]: 0.1 mm, 0.1 mrad.
constexpr double kLeastVariance = 1e-8;
// What the air of zones, doors and weather adds to the altimeter's own variance, and does not average out [m].
constexpr double kZoneM = 0.05;
// Dead reckoning with which ground was laid that no scan of the map before has shown.
constexpr double kLaidWayM = 3.0;
constexpr double kLaidS = 3.0;
// Longest step from which a velocity is taken [s].
constexpr double kLongestGapS = 0.5;

// Share of the ICP's standard deviations by which scans of one place scatter. It counts neighbouring pairs as one, which
// keeps the prior's say, and doubts far points by RegistrationConfig::attitude_error_deg; both are errors of the map.
constexpr double kScatterOfPosition = 0.5;
constexpr double kScatterOfTilt = 0.6;

// Covariance of errors whose components count by `shares`.
Matrix6d scaled(const Matrix6d& covariance, const Eigen::Matrix<double, 6, 1>& shares) {
  return shares.asDiagonal() * covariance * shares.asDiagonal();
}

// Error of a scan against known ground.
Matrix6d scan_error(const Matrix6d& covariance) {
  Eigen::Matrix<double, 6, 1> share = Eigen::Matrix<double, 6, 1>::Ones();
  share.head<3>().setConstant(kScatterOfPosition);
  share.segment<2>(3).setConstant(kScatterOfTilt);
  return scaled(covariance, share);
}

// Rows of a pose's covariance that the ICP moves: 1, else 0.
Eigen::Matrix<double, 6, 1> free_rows(const Basis& basis) {
  const Eigen::Matrix<double, 6, 1> of_twist = basis.rowwise().norm();
  Eigen::Matrix<double, 6, 1> rows;
  rows << of_twist.tail<3>(), of_twist.head<3>();
  return rows;
}

void leave_out_z(Matrix6d& covariance) {
  covariance.row(2).setZero();
  covariance.col(2).setZero();
}

// Projection on the directions of way that wheels hold where the scan does not.
Eigen::Matrix3d held_by_wheels(const Localisability& localisability) {
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < localisability.weak_count(); ++i) {
    const Direction& weak = localisability.directions[i];
    if (weak.holder != Holder::kWheels) continue;
    const Eigen::Vector3d along = Eigen::Map<const Eigen::Vector3f>(weak.axis.data()).cast<double>();
    held += (1.0 - static_cast<double>(weak.strength)) * along * along.transpose();
  }
  return held;
}

}  // namespace

void Registration::restart_drift(const Prior& prior) {
  // Of a map that begins level with gravity and keeps that: gravity has not settled at the first scan.
  const bool free_tilt = traits_.tilt == Constraint::kFree;
  state_.drift.restart(free_tilt ? offset_sigma_rad() : 0.0, unsettled_gravity_rad(prior));
  state_.unseen.restart();
  state_.posed = false;
}

void Registration::own_covariance(const Prior& end, const MethodTraits& traits, bool registered,
                                  PoseEstimate& pose) {
  const Eigen::Matrix<double, 6, 1> rows = free_rows(traits.basis);
  const bool adaptive = traits.method == Method::kAdaptive;
  Matrix6d covariance = Matrix6d::Zero();
  if (registered) {
    covariance = scaled(scan_error(pose.covariance), rows);
    lay_scan(traits, scaled(pose.covariance, rows), pose);
  } else {
    state_.unseen.move(end, step_to(end, pose.T_map_base));
    const Eigen::Vector3d p_map = pose.T_map_base.translation();
    if (end.ground_moves) {
      state_.drift.lift(p_map);
    } else {
      state_.drift.carry(p_map);
    }
  }
  watch_halt(end, pose);
  covariance += scaled(state_.drift.covariance(), rows);
  covariance(5, 5) += state_.halt.variance_rad2();
  if (adaptive) {
    // The owner of height knows its error, on known ground as well as when that was mapped.
    leave_out_z(covariance);
    covariance(2, 2) = (registered ? scan_error(pose.covariance)(2, 2) : kLeastVariance) + height_variance();
  }
  Matrix6d unseen = state_.unseen.covariance();
  if (adaptive) leave_out_z(unseen);
  covariance += unseen + mount_covariance(end, traits, pose.T_map_base);
  // The start is exact by definition, and a matrix of zeros is none.
  covariance.diagonal().array() += kLeastVariance;
  pose.covariance = covariance;
  fix_variances(end, traits, pose.covariance);
  state_.posed = true;
}

double Registration::height_variance() const {
  const double now_m2 = state_.height.variance_m2();
  if (!state_.drift.on_known_ground()) return now_m2;
  const double first_m2 = std::min(now_m2, state_.drift.height_variance_m2());
  return first_m2 + state_.drift.left_of_arrival() * (now_m2 - first_m2);
}

void Registration::lay_scan(const MethodTraits& traits, const Matrix6d& scan_covariance, PoseEstimate& pose) {
  if (state_.unseen.way_m() > kLaidWayM || state_.unseen.time_s() > kLaidS) {
    state_.drift.add_unseen(state_.unseen.covariance());
  }
  if (traits.method == Method::kAdaptive) state_.drift.know_tilt(state_.tilt.tilt_rad2());
  LaidScan laid;
  laid.T_map_base = pose.T_map_base;
  laid.covariance = scan_covariance;
  laid.levelled = traits.tilt == Constraint::kFixed;
  laid.offset_rad = offset_sigma_rad();
  laid.on_wheels = held_by_wheels(pose.localisability);
  laid.height_variance_m2 = state_.height.variance_m2();
  state_.drift.lay(laid);
  pose.on_known_ground = state_.drift.on_known_ground();
  const double dt_s = seconds_between(state_.last.stamp_ns, pose.stamp_ns);
  const bool moves = state_.posed && dt_s > 0.0 && dt_s < kLongestGapS;
  const Eigen::Vector3d step_m = pose.T_map_base.translation() - state_.last.T_map_base.translation();
  state_.unseen.restart(moves ? Eigen::Vector3d(step_m / dt_s) : Eigen::Vector3d::Zero());
}

void Registration::watch_halt(const Prior& end, const PoseEstimate& pose) {
  const Eigen::Matrix3d R = pose.T_map_odom.linear();
  if (halts(end)) {
    state_.halt.stand(pose.stamp_ns, yaw_of(R));
  } else if (state_.halt.standing()) {
    Matrix6d turned = Matrix6d::Zero();
    turned(5, 5) = state_.halt.variance_rad2();
    state_.drift.add(turned);
    state_.halt.leave();
  }
}

UnseenStep Registration::step_to(const Prior& end, const Eigen::Isometry3d& T_map_base) const {
  UnseenStep step;
  step.R_map_base = T_map_base.linear();
  step.tilt_rad = std::sqrt(state_.mount_doubt.variance_rad2());
  if (!state_.posed) return step;
  step.step_m = T_map_base.translation() - state_.last.T_map_base.translation();
  step.dt_s = std::max(0.0, seconds_between(state_.last.stamp_ns, end.stamp_ns));
  // A ride moves the robot, not its wheels.
  if (end.ground_moves) step.step_m.z() = 0.0;
  return step;
}

// z fixed by the altimeter errs as the air does.
void Registration::fix_variances(const Prior& prior, const MethodTraits& traits, Matrix6d& covariance) const {
  if (traits.tilt == Constraint::kFixed) {
    covariance.diagonal().segment<2>(3).array() += std::max(prior.roll_pitch_variance_rad2, kLeastVariance);
  }
  if (traits.height == Constraint::kFixed) {
    leave_out_z(covariance);
    covariance(2, 2) = std::max(prior.height_variance_m2, kLeastVariance) + squared(kZoneM);
  }
}

}  // namespace isobar
