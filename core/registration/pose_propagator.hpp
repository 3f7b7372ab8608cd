// SPDX-License-Identifier: BSD-3-Clause
// Pose of base_link between scans, in the two frames of REP-105: odom, continuous, and map, the best
// estimate, which jumps at corrections.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/pose_carrying.hpp"

namespace isobar {

struct PosePropagatorConfig {
  /// Time constant of the low-pass through which corrections of the registration enter the odom frame [s]. At
  /// the default, 86 % of a correction has entered after 0.2 s, two scans at 10 Hz: odometry follows the
  /// registered pose closely, and one bad scan is smoothed.
  double slew_time_s = 0.1;
  /// Rate limit of corrections of position [m/s]. Controllers see a correction as motion: walking pace.
  double max_slew_m_s = 1.0;
  /// Rate limit of corrections of orientation [rad/s].
  double max_slew_rad_s = 1.0;
  /// Without wheels: how long the velocity between the last scans is extrapolated [s].
  double max_extrapolation_s = 0.5;
};

/// Poses, twist and covariances for navigation at one time.
struct Odometry {
  std::int64_t stamp_ns = 0;
  std::uint32_t session = 1;  ///< number of the map frame, as in PoseEstimate
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();   ///< jumps at corrections
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();  ///< continuous
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();   ///< T_map_base = T_map_odom * T_odom_base
  Eigen::Vector3d v_base_m_s = Eigen::Vector3d::Zero();           ///< velocity of base_link in base_link
  Eigen::Vector3d w_base_rad_s = Eigen::Vector3d::Zero();         ///< angular rate in base_link
  Matrix6d pose_covariance = Matrix6d::Zero();   ///< of (x, y, z, roll, pitch, yaw), axes of the map
  Matrix6d twist_covariance = Matrix6d::Zero();  ///< of (v, w), axes of base_link
  double age_s = 0.0;                            ///< since the last registered pose
};

/// Propagates the last registered pose by the priors, which come many times between two scans. z follows the
/// altimeter or dead reckoning, whichever predicts z in the pose's effective method (traits_of()).
///
/// The odom frame of the result is not that of Prior::T_odom_base, which drifts without bound: the
/// registration's corrections enter it, low-passed and rate-limited. It continues when a new map frame begins
/// (PoseEstimate::session), when the map is corrected (PoseEstimate::map_moves), and when the robot turns out to be elsewhere
/// in the map (by kElsewhereM or kElsewhereRad): then only T_map_odom jumps. Allocates nothing. Not thread-safe.
class PosePropagator {
 public:
  /// A correction beyond one of these is no error of the last pose.
  static constexpr double kElsewhereM = 2.0;
  static constexpr double kElsewhereRad = 0.6;

  explicit PosePropagator(const PosePropagatorConfig& config = {});

  /// Takes a result of the registration. Ignores poses that are not finite, or not newer than the last one of
  /// their map frame.
  void add_pose(const PoseEstimate& pose);

  /// Pose at the time of `prior`. False, and `out` unchanged, where no pose has come yet or the prior is not
  /// finite or not newer than the last.
  bool propagate(const Prior& prior, Odometry& out);

 private:
  /// The registered pose that the priors propagate, with its source of z and its velocity. Fixed between two
  /// registrations: the motion between them is continuous.
  struct Anchor {
    PoseEstimate pose;
    PoseAnchor carried{Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
    double height_m = 0.0;  // altimeter at the pose's time
    bool follows_altimeter = false;
    Eigen::Vector3d v_map_m_s = Eigen::Vector3d::Zero();  // extrapolated without wheels
  };
  struct Height {
    std::int64_t stamp_ns = 0;
    double height_m = 0.0;
  };
  // Heights of the last 1.28 s at 400 Hz: more than the delay of any registered pose.
  static constexpr std::size_t kHeights = 512;

  void begin_session(const PoseEstimate& first);
  void follow_relocation(const PoseEstimate& pose);
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
  Eigen::Isometry3d T_odom_map_ = Eigen::Isometry3d::Identity();  // what the odom frame follows
  bool has_odometry_ = false;
  std::array<Height, kHeights> heights_{};
  std::size_t height_count_ = 0;
};

}  // namespace isobar
