// SPDX-License-Identifier: BSD-3-Clause
// Prediction of the robot's pose at the next scan, with its error.
#pragma once

#include <Eigen/Geometry>
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
};

/// Propagates the last registered pose: with wheels by the increments of dead reckoning, without wheels by
/// the decaying velocity of the registrations.
class MotionModel {
 public:
  explicit MotionModel(const RegistrationConfig& config) : config_(config) {}

  /// Takes over the motion of another model, not its configuration.
  void take_over(const MotionModel& other);

  /// Starts at yaw 0 and x = y = 0, with roll and pitch of the prior; z is its height, 0 without a barometer.
  void start(const Prior& prior);
  /// Starts at the position and yaw of `T_map_base`, with roll and pitch of the prior.
  void start_at(const Prior& prior, const Eigen::Isometry3d& T_map_base);
  /// A search has found the robot at `T_map_base`, the pose at the time of `now`; the velocity is unknown.
  void relocate(const Prior& now, const Eigen::Isometry3d& T_map_base);
  [[nodiscard]] bool started() const { return started_; }

  /// Precondition of all below: started().
  [[nodiscard]] Prediction predict(const Prior& now, const MethodTraits& method) const;

  /// The registration succeeded: `T_map_base` is the pose at the time of `now`.
  void correct(const Prior& now, const Eigen::Isometry3d& T_map_base);
  /// The registration failed: the next prediction starts from this one, with an error that grows.
  void keep_prediction(const Prior& now, const Prediction& prediction);

  /// Motion during a scan that ends at `end`.
  [[nodiscard]] ScanMotion scan_motion(const Prior& end, const Prediction& prediction) const;

 private:
  [[nodiscard]] Eigen::Vector3d step_at_velocity_map(const Prior& now) const;
  [[nodiscard]] double travel_s(const Prior& now) const;
  [[nodiscard]] double since_confirmed_s(std::int64_t stamp_ns) const;
  [[nodiscard]] Eigen::Vector3d velocity_at(std::int64_t stamp_ns) const;
  [[nodiscard]] double wheel_error_m(const Prior& now, double step_m, double dt_s) const;
  [[nodiscard]] double free_error_m(double dt_s) const;
  [[nodiscard]] double rotation_error_rad(double turn_rad, double rate_rad_s, double dt_s) const;

  RegistrationConfig config_;
  bool started_ = false;
  Prior last_;                                                    // prior at the last scan
  Eigen::Isometry3d T_map_base_ = Eigen::Isometry3d::Identity();  // pose at the last scan
  Eigen::Vector3d v_map_m_s_ = Eigen::Vector3d::Zero();           // filtered, of the last registrations
  std::int64_t confirmed_ns_ = 0;                                 // last scan that was registered
  double unconfirmed_m_ = 0.0;                                    // distance predicted since then
};

}  // namespace isobar
