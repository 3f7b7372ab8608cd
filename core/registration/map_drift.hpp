// SPDX-License-Identifier: BSD-3-Clause
// Error of the map where the robot is, against the start. Every scan of new ground is laid onto the scans before, and
// adds its own error; a scan of known ground is laid onto a map that has the error of its first visit.
//
//     new ground:    error <- moved(error) + C_scan x way / correlation      C_scan: what the ICP knows of one scan
//                    + scale of the wheels x way in directions that no surface holds
//     known ground:  error <- error at the first visit of the cell, by and by
//
// On arrival a scan lies on the new map behind it as well as on the old one ahead, and lets go of the former over metres.
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
  /// Constant tilt of lidar against gravity in axes of base_link, 1 sigma of roll and of pitch, as known now.
  double offset_rad = 0.0;
  bool levelled =
      false;  ///< gravity fixes roll and pitch: the ground is laid with that tilt wherever the robot heads
  /// Projection of a step on the directions that wheels hold and no surface: their scale makes an error there.
  Eigen::Matrix3d on_wheels = Eigen::Matrix3d::Zero();
  double height_variance_m2 = 0.0;  ///< kept for height_variance_m2()
};

/// Covariance of the map's error at the robot. Allocates in its constructor only.
class MapDrift {
 public:
  /// A new map frame. Where `offset_rad` is not zero, the map is tilted by it as a whole, see LaidScan::offset_rad;
  /// `gravity_rad`: 1 sigma of gravity's roll and pitch.
  void restart(double offset_rad = 0.0, double gravity_rad = 0.0);
  /// Continues at `p_map` in a map whose first visits are unknown: the error of a straight way from its origin.
  void restart_at(const Eigen::Vector3d& p_map);

  void lay(const LaidScan& scan);
  /// The robot has moved to `p_map` without a scan that shows it.
  void carry(const Eigen::Vector3d& p_map);
  /// The same of moving ground: it rises along gravity, however the map is tilted.
  void lift(const Eigen::Vector3d& p_map);
  /// An error that the map takes over from here on.
  void add(const Matrix6d& covariance) { here_.pose.random += covariance; }
  /// The error of dead reckoning with which new ground has been laid. Where the next scan shows known ground, it ends.
  void add_unseen(const Matrix6d& covariance) {
    add(covariance);
    look_again_ = true;
  }
  /// Another source knows the map's tilt to `variance_rad2`, of roll and of pitch.
  void know_tilt(double variance_rad2);

  [[nodiscard]] Matrix6d covariance() const;
  /// What a unit of the offset, axes x and y of base_link or of the map's start, has done to the pose.
  [[nodiscard]] Eigen::Matrix<double, 6, 2> offset_response() const {
    return (1.0 - left_of_arrival_) * here_.pose.constants.leftCols<2>();
  }
  /// LaidScan::height_variance_m2 of the last scan on new ground, of the first visit on known ground.
  [[nodiscard]] double height_variance_m2() const { return here_.height_variance_m2; }
  /// Share of the error on arrival at known ground that is left, 0 ... 1.
  [[nodiscard]] double left_of_arrival() const { return left_of_arrival_; }
  [[nodiscard]] bool on_known_ground() const { return known_; }

 private:
  [[nodiscard]] Matrix6d covariance_here() const;
  void look(const VisitedGround::Cell& cell);
  void add_constants(const LaidScan& scan, const Eigen::Vector3d& step_m);
  void grow(const Matrix6d& covariance, double way_m);

  VisitedGround visited_;
  MapError here_;
  Matrix6d on_arrival_ = Matrix6d::Zero();  // error on the last arrival at known ground ...
  double left_of_arrival_ = 0.0;            // ... and the share of it that is left
  double offset_rad_ = 0.0;
  double way_m_ = 0.0;
  VisitedGround::Cell cell_ = VisitedGround::Cell::Zero();
  Eigen::Vector3d p_map_ = Eigen::Vector3d::Zero();
  double grown_m_ = 0.0;  // way in this cell
  bool known_ = false;
  bool look_again_ = false;  // whether the ground is known, though the cell is the same
  bool started_ = false;
};

}  // namespace isobar
