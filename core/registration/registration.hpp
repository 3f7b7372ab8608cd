// SPDX-License-Identifier: BSD-3-Clause
// One scan in, one pose out:
//
//     prior at the scan's end ─▶ prediction ─▶ deskewed, thinned scan ─▶ ICP ─▶ gate ─▶ pose
//     (PriorHistory)           (MotionModel)   (prepare_scan)      (ScanMatcher)
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/prior/prior_history.hpp"
#include "core/registration/method.hpp"
#include "core/registration/motion_model.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/scan_matcher.hpp"
#include "core/registration/scan_preparation.hpp"

namespace isobar {

/// Registers scans to the map, starting from the prior. Allocates in its constructor only. Not thread-safe.
class Registration {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link.
  Registration(const RegistrationConfig& config, Method method, const Eigen::Isometry3d& T_base_lidar);

  /// Appends a prior; priors come in order of time.
  void add_prior(const Prior& prior);

  /// Takes over what another Registration with other settings has learnt: the pose goes on. Allocates nothing.
  void take_over(const Registration& other);

  /// True where the priors reach the end of the scan: register_scan() then extrapolates nothing.
  [[nodiscard]] bool ready(const Scan& scan) const;

  /// Estimates the pose at the end of `scan` against `map`; writes pose and deskewed, thinned points to
  /// `out`. Never fails: a scan that cannot be registered gets the predicted pose and mode kPriorOnly.
  void register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out);

  /// Pose at the newest prior, between scans and while the lidar is silent. False before the first scan with
  /// a pose in the map.
  bool propagate(PoseEstimate& out) const;

 private:
  [[nodiscard]] const MethodTraits& traits_for(const Prior& prior) const;
  [[nodiscard]] PoseEstimate description_of(const Prior& prior, const MethodTraits& traits) const;
  [[nodiscard]] Prior prior_at(std::int64_t stamp_ns) const;
  [[nodiscard]] Prior prior_without_imu(std::int64_t stamp_ns) const;
  bool start_motion(const Prior& prior);
  [[nodiscard]] MatchResult match(const MapSnapshot& map, const Prior& prior, const Prediction& prediction,
                                  const MethodTraits& traits);
  [[nodiscard]] bool acceptable(const MatchResult& match, const Prediction& prediction) const;
  [[nodiscard]] PoseMode mode_after(bool registered, const MethodTraits& traits);

  RegistrationConfig config_;
  Method asked_;
  MethodTraits traits_;  // without a height
  MethodTraits traits_with_height_;
  MethodTraits traits_without_imu_;  // IMU silent: the motion comes from the scans alone
  PriorHistory history_;
  MotionModel motion_;
  Deskewer deskewer_;
  Sampler sampler_;
  ScanMatcher matcher_;
  PoseEstimate last_;
  std::uint32_t scans_without_gravity_ = 0;
  std::uint32_t bootstrap_scans_ = 0;
  bool bootstrapping_ = true;  // no scan has been registered yet
};

}  // namespace isobar
