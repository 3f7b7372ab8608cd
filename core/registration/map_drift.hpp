// SPDX-License-Identifier: BSD-3-Clause
// Error of the map where the robot is, against the start. Every scan of new ground is laid onto the scans before, and
// adds its own error; a scan of known ground is laid onto a map that has the error of its first visit.
//
//     new ground:    error <- moved(error) + C_scan x way / correlation      C_scan: what the ICP knows of one scan
//                    + scale of the wheels x way in directions that no surface holds
//     known ground:  error <- error at the first visit of the cell
//
// So the way along a featureless corridor grows where wheels hold the pose, yaw on stairs, where few surfaces show it,
// and a robot that comes home is as sure as when it left.
#pragma once

#include <Eigen/Geometry>

#include "core/registration/growing_error.hpp"
#include "core/registration/visited_ground.hpp"

namespace isobar {

/// A registered scan.
struct LaidScan {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Matrix6d covariance =
      Matrix6d::Zero();  ///< of its pose against the map; zero in directions that the map does not hold
  double offset_rad =
      0.0;  ///< constant tilt against the ground in axes of base_link, 1 sigma of roll and of pitch
  /// Projection of a step on the directions that wheels hold and no surface: their scale makes an error there.
  Eigen::Matrix3d on_wheels = Eigen::Matrix3d::Zero();
  double height_variance_m2 = 0.0;  ///< kept for height_variance_m2()
};

/// Covariance of the map's error at the robot. Allocates in its constructor only.
class MapDrift {
 public:
  /// A new map frame; the map has a constant tilt of `tilt_rad`, 1 sigma of roll and of pitch.
  void restart(double tilt_rad = 0.0);
  /// Continues at `p_map` in a map whose first visits are unknown: the error of a straight way from its origin.
  void restart_at(const Eigen::Vector3d& p_map);

  void lay(const LaidScan& scan);
  /// The robot has moved to `p_map` without a scan that shows it.
  void carry(const Eigen::Vector3d& p_map);
  /// An error that the map takes over from here on.
  void add(const Matrix6d& covariance) { here_.pose.random += covariance; }
  /// The error of dead reckoning with which new ground has been laid. Where the next scan shows known ground, it ends.
  void add_unseen(const Matrix6d& covariance) {
    add(covariance);
    look_again_ = true;
  }
  /// Another source knows the map's tilt to `variance_rad2`, of roll and of pitch.
  void know_tilt(double variance_rad2);

  [[nodiscard]] Matrix6d covariance() const { return here_.pose.covariance(); }
  /// LaidScan::height_variance_m2 of the last scan on new ground, of the first visit on known ground.
  [[nodiscard]] double height_variance_m2() const { return here_.height_variance_m2; }
  [[nodiscard]] bool on_known_ground() const { return known_; }

 private:
  void add_constants(const LaidScan& scan, const Eigen::Vector3d& step_m);
  void grow(const Matrix6d& covariance, double way_m);

  VisitedGround visited_;
  MapError here_;
  VisitedGround::Cell cell_ = VisitedGround::Cell::Zero();
  Eigen::Vector3d p_map_ = Eigen::Vector3d::Zero();
  double grown_m_ = 0.0;  // way in this cell
  bool known_ = false;
  bool look_again_ = false;  // whether the ground is known, though the cell is the same
  bool started_ = false;
};

}  // namespace isobar
