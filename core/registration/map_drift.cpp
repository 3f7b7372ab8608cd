// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/map_drift.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/dead_reckoning_error.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Way over which errors of scans are one error: they see the same surfaces from nearly the same place. From the errors
// of 20 simulated runs of three methods, buildings and open ground.
constexpr double kPositionCorrelationM = 20.0;
// The same of angles, for a scan that knows them to kGyroStepRad, as the gyro knows a step. One that is sure of them keeps
// them longer; one that is not leaves them to the gyro, and the map with it.
constexpr double kRotationCorrelationM = 2.5;
constexpr double kGyroStepRad = 1e-3;
// Random walk of the position that no scan shows [m/sqrt(m)], level and upwards: planes of the map that are fitted to
// surfaces seen at a grazing angle, as floors are.
constexpr double kLeastWalkMSqrtM = 0.0018;
constexpr double kLeastWalkUpMSqrtM = 0.004;
// Way after which a neighbouring cell is known ground, not what the robot has just left; and way over which a scan lets go
// of the map behind it.
constexpr double kAwayM = 15.0;
constexpr double kArrivalM = 3.0;
// Typical errors of a map after a way, for one whose own is not known.
constexpr double kTypicalWalkMSqrtM = 0.01;
constexpr double kTypicalWalkRadSqrtM = 6e-4;
// Longest way on which one cell is new: a robot that circles in a room is on known ground.
constexpr double kNewWayM = 1.5 * VisitedGround::kCellM;

}  // namespace

void MapDrift::restart(double offset_rad, double gravity_rad) {
  visited_.clear();
  here_ = {};
  here_.pose.random(3, 3) = here_.pose.random(4, 4) = squared(gravity_rad);
  if (offset_rad != 0.0) here_.pose.constants(3, 0) = here_.pose.constants(4, 1) = 1.0;
  known_ = started_ = look_again_ = false;
  left_of_arrival_ = way_m_ = 0.0;
  offset_rad_ = offset_rad;
}

void MapDrift::restart_at(const Eigen::Vector3d& p_map) {
  restart();
  const double way_m = p_map.norm();
  // Yaw of an integrated walk errs by q s at the end, the position by q s^3 / 3, correlated with q s^2 / 2.
  GrowingError& pose = here_.pose;
  constexpr int kParts = 8;
  for (int i = 0; i < kParts; ++i) {
    pose.move(p_map / kParts);
    pose.random.diagonal().head<3>().array() += squared(kTypicalWalkMSqrtM) * way_m / kParts;
    pose.random(5, 5) += squared(kTypicalWalkRadSqrtM) * way_m / kParts;
  }
}

void MapDrift::lay(const LaidScan& scan) {
  const Eigen::Vector3d p_map = scan.T_map_base.translation();
  const Eigen::Vector3d step_m = started_ ? Eigen::Vector3d(p_map - p_map_) : Eigen::Vector3d::Zero();
  carry(p_map);
  way_m_ += step_m.norm();
  left_of_arrival_ *= std::exp(-step_m.norm() / kArrivalM);
  offset_rad_ = scan.offset_rad;
  add_constants(scan, step_m);
  const VisitedGround::Cell cell = VisitedGround::cell_of(p_map);
  const bool looks = !started_ || cell != cell_ || look_again_;
  if (looks) look(cell);
  if (!known_) {
    grow(scan.covariance, step_m.norm());
    here_.height_variance_m2 = scan.height_variance_m2;
    if (looks) visited_.add(cell, here_, way_m_);
  }
  started_ = true;
}

void MapDrift::look(const VisitedGround::Cell& cell) {
  look_again_ = false;
  cell_ = cell;
  grown_m_ = 0.0;
  const std::optional<MapError> first = visited_.find(cell, way_m_ - kAwayM);
  if (first && !known_ && started_) {
    on_arrival_ = covariance();
    left_of_arrival_ = 1.0;
  }
  known_ = first.has_value();
  if (known_) here_ = *first;
}

// The offset is known better while the robot drives, also that of the ground behind it.
Matrix6d MapDrift::covariance_here() const {
  const Eigen::Vector3d sigma(offset_rad_, offset_rad_, 1.0);
  const GrowingError::Constants constants = here_.pose.constants * sigma.asDiagonal();
  return here_.pose.random + constants * constants.transpose();
}

Matrix6d MapDrift::covariance() const {
  return (1.0 - left_of_arrival_) * covariance_here() + left_of_arrival_ * on_arrival_;
}

void MapDrift::carry(const Eigen::Vector3d& p_map) {
  if (started_) here_.pose.move(p_map - p_map_);
  p_map_ = p_map;
}

void MapDrift::lift(const Eigen::Vector3d& p_map) {
  p_map_.z() = p_map.z();
  carry(p_map);
}

// In units of the offset. Scans that are levelled by gravity have a floor that is inclined to the map's by it.
void MapDrift::add_constants(const LaidScan& scan, const Eigen::Vector3d& step_m) {
  GrowingError::Constants& constants = here_.pose.constants;
  for (int axis = 0; axis < 2 && scan.levelled; ++axis) {
    const Eigen::Vector3d pitch = scan.T_map_base.linear().col(axis);
    constants.col(axis).head<3>() += pitch.cross(step_m);
  }
  constants.col(2).head<3>() += kWheelScaleError * scan.on_wheels * step_m;
}

void MapDrift::grow(const Matrix6d& covariance, double way_m) {
  const double new_m = std::min(way_m, kNewWayM - grown_m_);
  if (!(new_m > 0.0)) return;
  grown_m_ += new_m;
  Eigen::Matrix<double, 6, 1> share;
  share.head<3>().setConstant(std::sqrt(new_m / kPositionCorrelationM));
  share.tail<3>() =
      std::sqrt(new_m / kRotationCorrelationM) / kGyroStepRad * covariance.diagonal().tail<3>().cwiseSqrt();
  here_.pose.random += share.asDiagonal() * covariance * share.asDiagonal();
  here_.pose.random.diagonal().head<2>().array() += squared(kLeastWalkMSqrtM) * new_m;
  here_.pose.random(2, 2) += squared(kLeastWalkUpMSqrtM) * new_m;
}

void MapDrift::know_tilt(double variance_rad2) {
  for (int axis = 3; axis < 5; ++axis) {
    Matrix6d& P = here_.pose.random;
    if (!(P(axis, axis) > 0.0)) {
      P(axis, axis) = variance_rad2;
      continue;
    }
    const double factor = std::sqrt(variance_rad2 / P(axis, axis));
    P.row(axis) *= factor;
    P.col(axis) *= factor;
  }
}

}  // namespace isobar
