// SPDX-License-Identifier: BSD-3-Clause
// Offset between gravity and the lidar, in axes of base_link, found while the robot turns.
//
// With t the tilt of the map, e the error of the lidar's mount and g that of gravity's direction (a bias of the
// accelerometer, the IMU's mount), all small rotation vectors,
//
//     R_map_base = exp(t^) R_true exp(e^),   up_map = R_map_base^T e_z,   up_gravity = exp(-g^) R_true^T e_z
//     up_gravity x up_map = c - R_map_base^T t,   c = g - e
//
// The map follows gravity less the offset c^ known so far, because gravity is in the prior of every scan: on a way of
// 1/k metres its tilt goes from t to R (c - c^). Without that term a wrong c^ would confirm itself.
//
// c turns with the robot and t does not: a quarter turn separates them, a straight drive cannot. A map that follows
// gravity with c left in is tilted by c wherever the robot mapped it: 0.5 deg are 0.9 % of height.
#pragma once

#include <Eigen/Core>

namespace isobar {

/// Kalman filter of c and t, two components each. Allocates nothing.
class TiltOffset {
 public:
  /// `sigma_rad`: a-priori standard deviation of c per axis.
  explicit TiltOffset(double sigma_rad);

  /// A new map, made level with gravity and the offset so far at its first scan.
  /// `gravity_variance_rad2`: of gravity's direction at that time, without its constant part.
  void restart(double gravity_variance_rad2 = 0.0);
  /// A new map, made level with the surfaces around the robot, whose tilt has this covariance, axes of the map.
  void restart_on_level(const Eigen::Matrix2d& covariance_rad2);
  /// A registered scan, `dt_s` after the last one, `moved_m` further on. `up_gravity_base`: unit vector.
  /// `gravity_variance_rad2`: of gravity's direction, without its constant part. `pull_variance_rad2`: that of gravity in
  /// the prior of the scan.
  void add(const Eigen::Matrix3d& R_map_base, const Eigen::Vector3d& up_gravity_base, double dt_s,
           double moved_m, double gravity_variance_rad2, double pull_variance_rad2);

  /// The mount has been corrected by `turn_rad` (axes of base_link): c is what is left of it.
  void turn_base(const Eigen::Vector3d& turn_rad) { x_.head<2>() += turn_rad.head<2>(); }

  /// c, as a rotation vector in axes of base_link: exp(c^) up_gravity is the map's up.
  [[nodiscard]] Eigen::Vector3d offset_rad() const { return {x_[0], x_[1], 0.0}; }
  [[nodiscard]] double offset_sigma_rad() const;
  /// Variance of t per axis.
  [[nodiscard]] double tilt_variance_rad2() const { return 0.5 * (P_(2, 2) + P_(3, 3)); }
  /// Second moment of t per axis: the map keeps what is known of its tilt.
  [[nodiscard]] double tilt_rad2() const { return 0.5 * (P_(2, 2) + P_(3, 3) + x_.tail<2>().squaredNorm()); }

 private:
  using Vector = Eigen::Vector4d;
  using Matrix = Eigen::Matrix4d;

  void follow_gravity(const Eigen::Matrix2d& R, double moved_m, double pull_variance_rad2);

  Vector x_ = Vector::Zero();  // c_x, c_y (base), t_x, t_y (map)
  Matrix P_ = Matrix::Zero();
};

}  // namespace isobar
