// SPDX-License-Identifier: BSD-3-Clause
// Where the robot should be at the next scan, and how sure that is.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/registration/deskew.hpp"
#include "core/registration/method.hpp"
#include "core/registration/registration_config.hpp"

namespace isobar {

/// Predicted pose and its error as a twist (omega, r) about the robot, axes of the map.
struct Prediction {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Vector6d deviation = Vector6d::Zero();  ///< standard deviation of each component
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
};

/// Carries the last registered pose on with the prior: increments of dead reckoning where there are wheels,
/// constant velocity of the registrations where there are none.
class MotionModel {
 public:
  explicit MotionModel(const RegistrationConfig& config) : config_(config) {}

  /// Starts at yaw 0 and x = y = 0, roll and pitch of the prior, z its height.
  void start(const Prior& prior);
  /// Continues from a pose that somebody else knows.
  void start_at(const Prior& prior, const Eigen::Isometry3d& T_map_base);
  [[nodiscard]] bool started() const { return started_; }

  [[nodiscard]] Prediction predict(const Prior& now, const MethodTraits& method) const;

  /// The registration agreed on `T_map_base` at the time of `now`.
  void correct(const Prior& now, const Eigen::Isometry3d& T_map_base);
  /// There was a scan, but the prediction stands: the next one starts here, with an error that grows.
  void keep_prediction(const Prior& now, const Prediction& prediction);

  /// Motion during a scan that ends at `end`.
  [[nodiscard]] ScanMotion scan_motion(const Prior& end, const Prediction& prediction) const;

 private:
  [[nodiscard]] Eigen::Vector3d translation_step_map(const Prior& now) const;
  [[nodiscard]] double travel_s(const Prior& now) const;
  [[nodiscard]] Eigen::Vector3d velocity_at(double since_s) const;

  RegistrationConfig config_;
  bool started_ = false;
  Prior last_;                                                    // prior at the last scan
  Eigen::Isometry3d T_map_base_ = Eigen::Isometry3d::Identity();  // pose at the last scan
  Eigen::Vector3d v_map_m_s_ = Eigen::Vector3d::Zero();           // of the last registrations
  std::int64_t confirmed_ns_ = 0;                                 // last scan that was registered
  double unconfirmed_m_ = 0.0;                                    // way since then
};

/// Rotation about z that is nearest to `rotation`: its yaw.
Eigen::Matrix3d yaw_only(const Eigen::Matrix3d& rotation);

}  // namespace isobar
