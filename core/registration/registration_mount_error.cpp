// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that says what errors of the mounts do to a pose. With g that of the IMU's mount and of the
// accelerometer, e that of the lidar's, axes of base_link, R = R_map_base and g0, e0 at the start:
//
//     roll, pitch   R g, or c0 + R e where the lidar holds them;   c = g - e tilts the ground that is laid
//     position      lever to the lidar x (R g - g0)
//     yaw           turns the map about the start
#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/registration/registration.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Biases of accelerometers, 2 to 5 mg, as an error of gravity.
constexpr double kAccelerometerRad = 3e-3;
// Largest error of gravity at the start, 1 sigma.
constexpr double kUnsettledGravityRad = 0.4 * kRadPerDeg;

// The map is turned about the start by the lidar's yaw mount, of second moment `mount_rad2`; the pose itself by what of
// it has been corrected since, `corrected_rad`.
Matrix6d turned_about_start(const Eigen::Vector3d& p_map, double mount_rad2, double corrected_rad) {
  Eigen::Matrix<double, 6, 1> turn = Eigen::Matrix<double, 6, 1>::Zero();
  turn.head<2>() << -p_map.y(), p_map.x();
  Matrix6d covariance = mount_rad2 * turn * turn.transpose();
  covariance.col(5) += squared(corrected_rad) * turn;
  covariance.row(5) += squared(corrected_rad) * turn.transpose();
  covariance(5, 5) += squared(corrected_rad);
  return covariance;
}

// Variance of roll and of pitch as that of the position, by their lever.
Matrix6d by_lever(const Eigen::Vector3d& lever_map_m, double variance_rad2) {
  const Eigen::Matrix<double, 3, 2> J = skew(lever_map_m).leftCols<2>();
  Matrix6d covariance = Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>() = variance_rad2 * J * J.transpose();
  return covariance;
}

}  // namespace

double Registration::unsettled_gravity_rad(const Prior& prior) {
  return std::min(std::sqrt(std::max(prior.roll_pitch_variance_rad2, 0.0)), kUnsettledGravityRad);
}

// Of c.
double Registration::offset_sigma_rad() const {
  return std::sqrt(2.0 * state_.mount_doubt.variance_rad2() + squared(kAccelerometerRad));
}

Matrix6d Registration::mount_covariance(const Prior& end, const MethodTraits& traits,
                                        const Eigen::Isometry3d& T_map_base) const {
  const Eigen::Matrix3d& R = T_map_base.linear();
  const double mount_rad2 = state_.mount_doubt.variance_rad2();
  const bool fixed = traits.tilt == Constraint::kFixed;
  const Eigen::Vector3d corrected_rad =
      log_so3(state_.q_base_lidar * Eigen::Quaterniond(T_base_lidar_.linear()).conjugate());
  Matrix6d covariance = turned_about_start(
      T_map_base.translation(), std::max(state_.mount_doubt.yaw_rad2(), squared(corrected_rad.z())),
      corrected_rad.z());
  covariance.diagonal().segment<2>(3).array() += mount_rad2;
  // Covariance of c with g, or with e.
  const Eigen::Matrix<double, 6, 2> common = (fixed ? mount_rad2 : -mount_rad2) *
                                             state_.drift.offset_response() *
                                             R.topLeftCorner<2, 2>().transpose();
  covariance.middleCols<2>(3) += common;
  covariance.middleRows<2>(3) += common.transpose();
  const double cosine = std::clamp(R(0, 0), -1.0, 1.0);
  const double since_start_rad2 = 2.0 * (1.0 - cosine) * mount_rad2 +
                                  0.5 * corrected_rad.head<2>().squaredNorm() +
                                  (fixed ? squared(unsettled_gravity_rad(end)) : 0.0);
  return covariance + by_lever(R * T_base_lidar_.translation(), since_start_rad2);
}

}  // namespace isobar
