// SPDX-License-Identifier: BSD-3-Clause
// The pose of base_link between scans, in the two frames of REP-105: odom, in which it never jumps, and map,
// in which it is as right as is known.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

struct PosePropagatorConfig {
  /// Time constant with which a correction of the registration enters the odom frame [s]. Two of
  /// them, 0.2 s, are two scans: odometry follows the registered pose closely, and one bad scan is smoothed.
  double slew_time_s = 0.1;
  /// Fastest correction of position [m/s]. Controllers see a correction as motion: it stays at walking
  /// pace.
  double max_slew_m_s = 1.0;
  /// Fastest correction of orientation [rad/s].
  double max_slew_rad_s = 1.0;
  /// Without wheels the velocity between the last scans is taken on for this long at most [s].
  double max_extrapolation_s = 0.5;
};

/// What navigation needs at one time.
struct Odometry {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();   ///< best estimate; jumps at corrections
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();  ///< continuous
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();   ///< T_map_base = T_map_odom * T_odom_base
  Eigen::Vector3d v_base_m_s = Eigen::Vector3d::Zero();           ///< velocity of base_link in base_link
  Eigen::Vector3d w_base_rad_s = Eigen::Vector3d::Zero();         ///< angular rate in base_link
  Matrix6d pose_covariance = Matrix6d::Zero();   ///< of (x, y, z, roll, pitch, yaw), axes of the map
  Matrix6d twist_covariance = Matrix6d::Zero();  ///< of (v, w), axes of base_link
  double age_s = 0.0;                            ///< time since the scan that it rests on
};

/// Carries the last registered pose on with the priors, which come many times between two scans.
///
/// The odom frame of the result is not that of Prior::T_odom_base, which drifts without bound: it takes in
/// the registration's corrections, but gradually. Allocates nothing.
class PosePropagator {
 public:
  explicit PosePropagator(const PosePropagatorConfig& config = {});

  /// A new result of the registration. Poses that are not finite, or not younger than the last, are ignored.
  void add_pose(const PoseEstimate& pose);

  /// The pose at the time of this prior.
  /// @return false, and `out` is untouched: there has been no pose yet, the prior is not finite or not
  /// younger
  ///         than the last one
  bool propagate(const Prior& prior, Odometry& out);

 private:
  /// The registered pose that priors carry on, with all that decides how, so that between two registrations
  /// the motion has no break.
  struct Anchor {
    PoseEstimate pose;
    double height_m = 0.0;  ///< altimeter at the pose's time
    bool follows_altimeter = false;
    Eigen::Vector3d v_map_m_s = Eigen::Vector3d::Zero();  ///< taken on where there are no wheels
  };
  struct Height {
    std::int64_t stamp_ns = 0;
    double height_m = 0.0;
  };
  /// Priors of the last 1.28 s at 400 Hz; a registration that takes longer has lost its scans.
  static constexpr std::size_t kHeights = 512;

  [[nodiscard]] Eigen::Isometry3d best_pose(const Prior& prior) const;
  [[nodiscard]] bool height_at(std::int64_t stamp_ns, double& height_m) const;
  [[nodiscard]] Eigen::Vector3d registered_velocity(const PoseEstimate& pose) const;
  void slew_towards(const Eigen::Isometry3d& target, double elapsed_s);
  void fill_twist(const Prior& prior, Odometry& out) const;
  void fill_covariance(const Prior& prior, Odometry& out) const;

  PosePropagatorConfig config_;
  Anchor anchor_;
  bool has_anchor_ = false;
  Prior last_prior_;
  bool has_prior_ = false;
  Eigen::Isometry3d T_odom_base_ = Eigen::Isometry3d::Identity();
  bool has_odometry_ = false;
  std::array<Height, kHeights> heights_{};
  std::size_t height_count_ = 0;
};

}  // namespace isobar
