// SPDX-License-Identifier: BSD-3-Clause
// Whether the registered poses contradict the other sensors: the robot is lost, and no scan says so.
//
// A scan that is matched to a smeared map overlaps it, and has small residuals. But an error that grows is motion that
// did not take place, and the gyro and gravity have not seen it:
//
//     turn  over 1 s and 4 s, registered against gyro      tilt  registered against gravity
//
// Measured on 44 simulated recordings in which the pose is right, and on moulin-1m, which is lost from its sixth
// second on (turn less 5 % of the gyro's, largest of a run):
//
//              right                              lost
//     1 s      1.7 deg (a mount 0.9 deg off)      4.9 deg
//     4 s      3.9 deg (6-DOF without wheels)     18 deg
//     tilt     3.2 deg with wheels, 9.3 without   51 deg
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

/// A registered scan, and what other sensors say at its time.
struct LostEvidence {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();  ///< Prior::T_odom_base
  double tilt_sd_rad = 0.0;                                       ///< of gravity's roll and pitch
  double turn_rate_sd_rad_s = 0.0;                                ///< of the gyro
  /// Wheels tell accelerations from gravity. Without them gravity turns roll and pitch of T_odom_base by degrees while the
  /// robot speeds up, and only its yaw is the gyro's.
  bool on_wheels = true;
};

/// Judges registered scans in order of time. Allocates nothing. Not thread-safe.
class LostDetector {
 public:
  /// Forgets all scans: the next pose is right.
  void restart() { count_ = 0, contradicted_ = 0; }

  /// @return why the robot is lost, kNone while nothing contradicts the poses
  LostReason add(const LostEvidence& evidence);

  /// The last scan before the contradiction. Precondition: add() has returned another reason than kNone.
  [[nodiscard]] const LostEvidence& last_good() const { return good_; }

 private:
  /// Scans kept: those of the last kMemoryS, kSpacingNs apart at least.
  static constexpr std::size_t kKept = 64;

  [[nodiscard]] const LostEvidence* before(std::int64_t stamp_ns, double age_s) const;
  [[nodiscard]] LostReason judge(const LostEvidence& now, const LostEvidence*& since) const;
  void keep(const LostEvidence& evidence);

  std::array<LostEvidence, kKept> kept_{};  // ring
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  int contradicted_ = 0;  // scans in a row
  LostEvidence good_;
};

}  // namespace isobar
