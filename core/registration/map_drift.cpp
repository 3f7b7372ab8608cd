// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/map_drift.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/dead_reckoning_error.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Way over which errors of scans are one error: they see the same surfaces from nearly the same place. From the errors
// of 30 simulated runs of three methods, buildings and open ground.
constexpr double kPositionCorrelationM = 3.3;
constexpr double kRotationCorrelationM = 1.4;
// Random walk of the position that no scan shows [m/sqrt(m)]: planes of the map that are fitted to surfaces seen at a
// grazing angle.
constexpr double kLeastWalkMSqrtM = 0.004;
// Typical errors of a map after a way, for one whose own is not known.
constexpr double kTypicalWalkMSqrtM = 0.01;
constexpr double kTypicalWalkRadSqrtM = 6e-4;
// Longest way on which one cell is new: a robot that circles in a room is on known ground.
constexpr double kNewWayM = 1.5 * VisitedGround::kCellM;

}  // namespace

void MapDrift::restart(double tilt_rad) {
  visited_.clear();
  here_ = {};
  here_.pose.random(3, 3) = here_.pose.random(4, 4) = squared(tilt_rad);
  known_ = started_ = look_again_ = false;
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
  add_constants(scan, step_m);
  const VisitedGround::Cell cell = VisitedGround::cell_of(p_map);
  const bool looks = !started_ || cell != cell_ || look_again_;
  if (looks) {
    look_again_ = false;
    cell_ = cell;
    grown_m_ = 0.0;
    const std::optional<MapError> first = visited_.find(cell);
    known_ = first.has_value();
    if (known_) here_ = *first;
  }
  if (!known_) {
    grow(scan.covariance, step_m.norm());
    here_.height_variance_m2 = scan.height_variance_m2;
    if (looks) visited_.add(cell, here_);
  }
  started_ = true;
}

void MapDrift::carry(const Eigen::Vector3d& p_map) {
  if (started_) here_.pose.move(p_map - p_map_);
  p_map_ = p_map;
}

// Scans that are levelled by gravity have a floor that is inclined to the map's by the offset, wherever they head.
void MapDrift::add_constants(const LaidScan& scan, const Eigen::Vector3d& step_m) {
  GrowingError::Constants& constants = here_.pose.constants;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d turn_rad = scan.offset_rad * scan.T_map_base.linear().col(axis);
    constants.col(axis).head<3>() += turn_rad.cross(step_m);
  }
  constants.col(2).head<3>() += kWheelScaleError * scan.on_wheels * step_m;
}

void MapDrift::grow(const Matrix6d& covariance, double way_m) {
  const double new_m = std::min(way_m, kNewWayM - grown_m_);
  if (!(new_m > 0.0)) return;
  grown_m_ += new_m;
  Eigen::Matrix<double, 6, 1> share;
  share.head<3>().setConstant(std::sqrt(new_m / kPositionCorrelationM));
  share.tail<3>().setConstant(std::sqrt(new_m / kRotationCorrelationM));
  here_.pose.random += share.asDiagonal() * covariance * share.asDiagonal();
  here_.pose.random.diagonal().head<3>().array() += squared(kLeastWalkMSqrtM) * new_m;
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
