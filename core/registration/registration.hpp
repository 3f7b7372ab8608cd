// SPDX-License-Identifier: BSD-3-Clause
// One scan in, one pose out: deskew, sample, match, solve, judge.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/prior/prior_history.hpp"
#include "core/registration/correspondences.hpp"
#include "core/registration/deskew.hpp"
#include "core/registration/method.hpp"
#include "core/registration/motion_model.hpp"
#include "core/registration/point_to_plane.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/sampling.hpp"
#include "core/registration/scan_preparation.hpp"
#include "core/registration/solver.hpp"

namespace isobar {

/// Registers scans to the map, starting from the prior. Allocates in its constructor only. One thread.
class Registration {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link.
  Registration(const RegistrationConfig& config, Method method, const Eigen::Isometry3d& T_base_lidar);

  /// Takes a prior; they must come in order of time.
  void add_prior(const Prior& prior);

  /// True where the priors reach the end of the scan, so that register_scan() need not extrapolate.
  [[nodiscard]] bool ready(const Scan& scan) const;

  /// Estimates the pose at the end of `scan` against `map`; writes pose and deskewed, thinned points to
  /// `out`. Never fails: what cannot be registered gets the prior's pose and mode kPriorOnly.
  void register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out);

  /// Pose at the newest prior, for the time between scans and without any. False until a scan has started the
  /// map.
  bool propagate(PoseEstimate& out) const;

 private:
  // Wider than this a search finds the wrong wall more often than the right one.
  static constexpr double kLargestSearchM = 2.0;

  [[nodiscard]] const MethodTraits& traits_for(const Prior& prior) const;
  void describe(const Prior& prior, const MethodTraits& traits, PoseEstimate& pose) const;
  void prior_without_imu(std::int64_t stamp_ns, Prior& end) const;
  bool begin(const Scan& scan, Prior& end, PoseEstimate& pose);
  [[nodiscard]] PairNoise pair_noise(const MethodTraits& traits, const Prior& prior) const;
  bool solve(const MapSnapshot& map, const Prediction& prediction, const MethodTraits& traits,
             const Prior& prior, PoseEstimate& pose, Matrix6d& twist_covariance);
  [[nodiscard]] bool acceptable(const PoseEstimate& pose, const Prediction& prediction) const;
  void finish(const Prior& prior, const MethodTraits& traits, const Matrix6d& twist_covariance,
              PoseEstimate& pose);

  RegistrationConfig config_;
  Method asked_;
  MethodTraits traits_;              // while there is no height
  MethodTraits traits_with_height_;  // once there is
  MethodTraits traits_without_imu_;  // while the IMU is silent: the scans alone say how the robot moves
  Eigen::Isometry3d T_base_lidar_;
  PriorHistory history_;
  MotionModel motion_;
  Deskewer deskewer_;
  Sampler sampler_;
  Correspondences correspondences_;
  PoseEstimate last_;
  std::uint32_t waited_ = 0;         // scans before gravity was known
  bool starting_ = true;             // no scan was registered yet
  std::uint32_t started_scans_ = 0;  // scans since the map was started
};

}  // namespace isobar
