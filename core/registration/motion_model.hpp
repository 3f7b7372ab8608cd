// SPDX-License-Identifier: BSD-3-Clause
// Prediction of the robot's pose at the next scan, with its error.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/registration/deskew.hpp"
#include "core/registration/method.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/twist.hpp"

namespace isobar {

/// Predicted pose and the standard deviation of its error as a twist (omega, r) about the robot, axes of the
/// map.
struct Prediction {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Vector6d deviation = Vector6d::Zero();  ///< of each component [rad, m]
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
  /// Who knows each component.
  std::array<Holder, 6> holders{Holder::kMotion, Holder::kMotion, Holder::kMotion,
                                Holder::kMotion, Holder::kMotion, Holder::kMotion};
};

/// Constant offset between gravity and the lidar, see TiltOffset: rotation vector in axes of base_link, 1 sigma.
struct GravityOffset {
  Eigen::Vector3d offset_rad = Eigen::Vector3d::Zero();
  double sigma_rad = 0.0;
};

/// Standard deviation of gravity's roll and pitch in the prior of a scan [rad]: `known_rad` once its offset is known.
[[nodiscard]] double gravity_sigma_rad(double known_rad, double offset_sigma_rad);

/// Propagates the last registered pose by the increments of dead reckoning; without wheels by the decaying velocity of
/// the registrations, and without gyro and wheels by their decaying turn rate.
class MotionModel {
 public:
  explicit MotionModel(const RegistrationConfig& config) : config_(config) {}

  /// Takes over the motion of another model, not its configuration.
  void take_over(const MotionModel& other);

  /// Starts at yaw 0 and x = y = 0, with roll and pitch of gravity less its `offset_rad` (TiltOffset); z is its height, 0 without a barometer.
  void start(const Prior& prior, const Eigen::Vector3d& offset_rad = Eigen::Vector3d::Zero());
  /// Starts at the position and yaw of `T_map_base`, with roll and pitch of the prior.
  void start_at(const Prior& prior, const Eigen::Isometry3d& T_map_base);
  /// A search has found the robot at `T_map_base`, the pose at the time of `now`; the velocity is unknown.
  void relocate(const Prior& now, const Eigen::Isometry3d& T_map_base);
  /// The map has been moved: the robot goes on in it with the same motion. `T`: about z.
  void follow_map(const Eigen::Isometry3d& T_now_before);
  [[nodiscard]] bool started() const { return started_; }
  /// Pose of the last scan.
  [[nodiscard]] const Eigen::Isometry3d& T_map_base() const { return T_map_base_; }

  /// Precondition of all below: started(). `offset`: for methods whose tilt is soft.
  [[nodiscard]] Prediction predict(const Prior& now, const MethodTraits& method,
                                   const GravityOffset& offset = {}) const;

  /// Few scans have been registered since the start, and no wheels tell the speed.
  [[nodiscard]] bool speed_unknown(const Prior& now) const;
  /// Time since the last scan [s].
  [[nodiscard]] double travel_s(const Prior& now) const;

  /// The turn up to `now` is known, by the gyro or by wheels.
  [[nodiscard]] bool turn_known(const Prior& now) const;
  /// Motion during a scan that has been found at `T_map_base` at its end, without gyro and wheels.
  [[nodiscard]] ScanMotion motion_towards(const Prior& end, const Eigen::Isometry3d& T_map_base) const;

  /// The registration succeeded: `T_map_base` is the pose at the time of `now`.
  void correct(const Prior& now, const Eigen::Isometry3d& T_map_base);
  /// The registration failed: the next prediction starts from this one, with an error that grows.
  void keep_prediction(const Prior& now, const Prediction& prediction);

  /// The lidar's rotation in base_link has become R R_base_lidar: base_link turns so that the lidar stays.
  void turn_base(const Eigen::Matrix3d& R);

  /// Motion during a scan that ends at `end`.
  [[nodiscard]] ScanMotion scan_motion(const Prior& end, const Prediction& prediction) const;

 private:
  struct Twist {
    Eigen::Vector3d v_map_m_s;
    Eigen::Vector3d w_base_rad_s;
  };

  /// The IMU has followed the turn since the last scan.
  [[nodiscard]] bool followed(const Prior& now) const { return now.attitude_valid && last_.attitude_valid; }
  [[nodiscard]] bool on_wheels(const Prior& now) const { return now.velocity_valid && last_.velocity_valid; }
  /// Mean velocity and turn rate from the last scan to `T_map_base`, `dt_s` later.
  [[nodiscard]] Twist twist_to(const Eigen::Isometry3d& T_map_base, double dt_s) const;
  [[nodiscard]] Eigen::Vector3d step_at_velocity_map(const Prior& now) const;
  void turn_on(const Prior& now, Prediction& prediction) const;
  [[nodiscard]] double since_confirmed_s(std::int64_t stamp_ns) const;
  [[nodiscard]] Eigen::Vector3d velocity_at(std::int64_t stamp_ns) const;
  [[nodiscard]] Eigen::Vector3d turn_rate_at(std::int64_t stamp_ns) const;
  [[nodiscard]] double wheel_error_m(const Prior& now, double step_m, double dt_s) const;
  [[nodiscard]] double free_error_m(double dt_s) const;
  [[nodiscard]] double start_error_m(const Prior& now) const;
  [[nodiscard]] double rotation_error_rad(double turn_rad, double rate_rad_s, double dt_s) const;

  RegistrationConfig config_;
  bool started_ = false;
  Prior last_;           // prior at the last scan
  double lift_m_ = 0.0;  // of the map over the altimeter, by follow_map()
  Eigen::Isometry3d T_map_base_ = Eigen::Isometry3d::Identity();  // pose at the last scan
  Eigen::Vector3d v_map_m_s_ = Eigen::Vector3d::Zero();           // filtered, of the last registrations
  Eigen::Vector3d w_base_rad_s_ = Eigen::Vector3d::Zero();        // turn rate of the last step
  std::int64_t confirmed_ns_ = 0;                                 // last scan that was registered
  int registered_ = 0;                                            // scans since the start
  double unconfirmed_m_ = 0.0;                                    // distance predicted since then
};

}  // namespace isobar
