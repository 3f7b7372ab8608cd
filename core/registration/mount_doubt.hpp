// SPDX-License-Identifier: BSD-3-Clause
// How well the mounts of this robot are known. Hands that have put the lidar exactly where the configuration says have done
// so with the IMU; of a lidar that sits 0.7 deg off, the IMU is hardly better. So what the scans show of the lidar's mount
// estimates the variance s^2 of all of them, with s_0^2 as half an observation before any:
//
//     s^2 = (s_0^2 / 2 + sum w_i x_i^2 / k_i) / (1/2 + sum w_i)    x_i   error found of an angle, w_i share of evidence
//                                                                  k_i   2 against the IMU, whose mount errs as well, else 1
#pragma once

#include "core/mounts/mount_estimator.hpp"

namespace isobar {

/// Variance of mounts, and of the lidar's yaw. Allocates nothing.
class MountDoubt {
 public:
  /// `sigma_rad`: of one mount and angle, before any evidence.
  explicit MountDoubt(double sigma_rad)
      : prior_rad2_(sigma_rad * sigma_rad), variance_rad2_(prior_rad2_), yaw_rad2_(prior_rad2_) {}

  /// `tilt_shown`: the scans show roll and pitch, no one has fixed them.
  void learn(const MountEstimate& found, bool tilt_shown);

  /// Of one mount, one angle.
  [[nodiscard]] double variance_rad2() const { return variance_rad2_; }
  /// Second moment of the lidar's configured yaw, by which the map is turned about the start.
  [[nodiscard]] double yaw_rad2() const { return yaw_rad2_; }

 private:
  double prior_rad2_;
  double variance_rad2_;
  double yaw_rad2_;
};

}  // namespace isobar
