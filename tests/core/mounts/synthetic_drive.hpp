// SPDX-License-Identifier: BSD-3-Clause
// A robot that drives and turns, with its priors and the poses of its scans, in closed form.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

#include "core/geometry.hpp"
#include "core/mounts/mount_estimator.hpp"
#include "core/so3.hpp"

namespace isobar::test {

/// Errors of the robot and of its registration.
struct DriveErrors {
  Eigen::Vector3d mount_deg = Eigen::Vector3d::Zero();  ///< true = exp(mount) configured
  double scan_deg = 0.0;                                ///< white noise of a scan's attitude, per axis
  double lost_deg_rthz = 0.0;                           ///< random walk of a scan's attitude, per axis
  double position_m = 0.0;                              ///< white noise of a scan's position, per axis
  double wheel_distance = 1.0;                          ///< wheels' distance over the true one
  double wheel_turn = 1.0;                              ///< wheels' turn over the true one
  bool wheels = true;                                   ///< the robot has wheels
};

/// Moves in arcs at constant rates: IMU at 200 Hz, scans at 10 Hz. Feeds a MountEstimator.
class SyntheticDrive {
 public:
  SyntheticDrive(const Eigen::Quaterniond& q_configured, const DriveErrors& errors, std::uint64_t seed)
      : errors_(errors),
        q_configured_(q_configured),
        q_used_(q_configured),
        q_true_(exp_so3(errors.mount_deg * kRadPerDeg) * q_configured),
        estimator_(q_configured),
        random_(seed) {}

  /// Drives for `seconds` at `speed_m_s` along x of base_link and turns by `w_base_deg_s`.
  void drive(double seconds, double speed_m_s, const Eigen::Vector3d& w_base_deg_s) {
    const Eigen::Vector3d w = w_base_deg_s * kRadPerDeg;
    const auto steps = static_cast<int>(seconds * 200.0 + 0.5);
    for (int i = 0; i < steps; ++i) {
      q_ = (q_ * exp_so3(w * kStepS)).normalized();
      const Eigen::Vector3d step_m = q_ * Eigen::Vector3d(speed_m_s * kStepS, 0.0, 0.0);
      p_ += step_m;
      p_wheels_ += errors_.wheel_distance * step_m;
      wheel_turn_rad_ += errors_.wheel_turn * w.z() * kStepS;
      stamp_ns_ += 5'000'000;
      add_prior(w, speed_m_s);
      if (++since_scan_ == 20) add_scan();
    }
  }

  /// The registration uses another mount from now on.
  void use_mount(const Eigen::Quaterniond& q_used) { q_used_ = q_used; }
  /// No scan is registered until silent(false).
  void silent(bool on) { silent_ = on; }
  void next_session() { ++session_; }

  [[nodiscard]] MountEstimator& estimator() { return estimator_; }
  [[nodiscard]] MountEstimate estimate() const { return estimator_.estimate(); }
  /// Error of the estimate, roll, pitch, yaw [deg].
  [[nodiscard]] Eigen::Vector3d error_deg() const {
    return estimate().error_rad / kRadPerDeg - errors_.mount_deg;
  }

 private:
  static constexpr double kStepS = 0.005;

  void add_prior(const Eigen::Vector3d& w, double speed_m_s) {
    Prior prior;
    prior.stamp_ns = stamp_ns_;
    prior.T_odom_base.linear() = q_.toRotationMatrix();
    prior.T_odom_base.translation() = p_wheels_;
    prior.w_base_rad_s = w;
    prior.v_base_m_s.x() = speed_m_s;
    prior.attitude_valid = true;
    prior.velocity_valid = errors_.wheels;
    history_.add(prior);
  }

  void add_scan() {
    since_scan_ = 0;
    lost_ = (lost_ * exp_so3(vector(errors_.lost_deg_rthz * kRadPerDeg * std::sqrt(0.1)))).normalized();
    if (silent_) return;
    ScanMotionEvidence scan;
    scan.stamp_ns = stamp_ns_;
    scan.session = session_;
    // The scans measure the attitude of the true lidar; the used mount makes base_link's of it.
    const Eigen::Quaterniond q_map_lidar =
        lost_ * q_ * exp_so3(vector(errors_.scan_deg * kRadPerDeg)) * q_true_;
    scan.q_base_lidar = q_used_;
    scan.T_map_base.linear() = (q_map_lidar * q_used_.conjugate()).toRotationMatrix();
    scan.T_map_base.translation() = p_ + vector(errors_.position_m);
    scan.wheel_turn_rad = wheel_turn_rad_;
    wheel_turn_rad_ = 0.0;
    estimator_.add(scan, history_);
  }

  Eigen::Vector3d vector(double sigma) {
    const double x = normal_(random_);
    const double y = normal_(random_);
    return sigma * Eigen::Vector3d(x, y, normal_(random_));
  }

  DriveErrors errors_;
  Eigen::Quaterniond q_configured_;
  Eigen::Quaterniond q_used_;
  Eigen::Quaterniond q_true_;
  MountEstimator estimator_;
  PriorHistory history_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::Quaterniond q_ = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond lost_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_wheels_ = Eigen::Vector3d::Zero();
  double wheel_turn_rad_ = 0.0;
  std::int64_t stamp_ns_ = 1'000'000'000;
  std::uint32_t session_ = 1;
  int since_scan_ = 0;
  bool silent_ = false;
};

}  // namespace isobar::test
