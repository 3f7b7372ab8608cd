// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/tilt_offset.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Random walk of the map's tilt with the way [rad/sqrt(m)]: 0.02 deg a metre of new ground.
constexpr double kTiltWalkRadSqrtM = 6e-4;
// Random walk of the offset of the mean force [rad/sqrt(s)]: temperature moves the accelerometer's bias by 2 mg in minutes,
// a flexing mast as much.
constexpr double kOffsetWalkRadSqrtS = 2e-4;
// Correlation time of gravity's direction in an attitude filter [s], and the least error of it and of a scan [rad].
constexpr double kGravityTimeS = 4.0;
constexpr double kLeastSigmaRad = 1.2e-3;
// Error of a scan's attitude against the map [rad], and the way on which new ground replaces what a scan is laid onto.
constexpr double kScanSigmaRad = 3.5e-4;
constexpr double kMemoryM = 3.0;
// Innovation beyond which a scan says nothing, in standard deviations of one scan.
constexpr double kTiltGateSigmas = 4.0;

}  // namespace

TiltOffset::TiltOffset(double sigma_rad) {
  P_.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() * squared(sigma_rad);
  restart();
}

// Level with gravity and the offset: what the offset errs by is the tilt of the map.
void TiltOffset::restart(double gravity_variance_rad2) {
  x_.tail<2>().setZero();
  P_.bottomRightCorner<2, 2>() =
      P_.topLeftCorner<2, 2>() + gravity_variance_rad2 * Eigen::Matrix2d::Identity();
  P_.bottomLeftCorner<2, 2>() = P_.topLeftCorner<2, 2>();
  P_.topRightCorner<2, 2>() = P_.topLeftCorner<2, 2>();
}

void TiltOffset::restart_on_level(const Eigen::Matrix2d& covariance_rad2) {
  restart();
  P_.bottomRightCorner<2, 2>() = covariance_rad2;
  P_.bottomLeftCorner<2, 2>().setZero();
  P_.topRightCorner<2, 2>().setZero();
}

double TiltOffset::offset_sigma_rad() const { return std::sqrt(std::max(0.0, std::max(P_(0, 0), P_(1, 1)))); }

// t <- t + k s (R (c - c^) - t), c^ being the present estimate.
void TiltOffset::follow_gravity(const Eigen::Matrix2d& R, double moved_m, double pull_variance_rad2) {
  const double share = squared(kScanSigmaRad) / (squared(kScanSigmaRad) + pull_variance_rad2);
  const double part = std::min(1.0, share * moved_m / kMemoryM);
  Matrix F = Matrix::Identity();
  F.bottomLeftCorner<2, 2>() = part * R;
  F.bottomRightCorner<2, 2>() *= 1.0 - part;
  x_.tail<2>() *= 1.0 - part;
  P_ = (F * P_ * F.transpose()).eval();
}

void TiltOffset::add(const Eigen::Matrix3d& R_map_base, const Eigen::Vector3d& up_gravity_base, double dt_s,
                     double moved_m, double gravity_variance_rad2, double pull_variance_rad2) {
  follow_gravity(R_map_base.topLeftCorner<2, 2>(), moved_m, pull_variance_rad2);
  P_.diagonal().head<2>().array() += squared(kOffsetWalkRadSqrtS) * dt_s;
  P_.diagonal().tail<2>().array() += squared(kTiltWalkRadSqrtM) * moved_m;
  const Eigen::Vector3d up_map = R_map_base.row(2).transpose();
  const Eigen::Vector2d measured = up_gravity_base.cross(up_map).head<2>();
  Eigen::Matrix<double, 2, 4> H;
  H << Eigen::Matrix2d::Identity(), -R_map_base.topLeftCorner<2, 2>().transpose();
  const double one_scan = std::max(gravity_variance_rad2, squared(kLeastSigmaRad));
  const Eigen::Vector2d innovation = measured - H * x_;
  const Eigen::Matrix2d predicted = H * P_ * H.transpose();
  if (innovation.squaredNorm() > squared(kTiltGateSigmas) * (2.0 * one_scan + predicted.trace())) return;
  // White noise of the density of the correlated error.
  const double white = one_scan * std::max(1.0, 2.0 * kGravityTimeS / std::max(dt_s, 1e-3));
  const Eigen::Matrix2d S = predicted + Eigen::Matrix2d::Identity() * white;
  const Eigen::Matrix<double, 4, 2> K = P_ * H.transpose() * S.inverse();
  x_ += K * innovation;
  P_ -= K * H * P_;
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

}  // namespace isobar
