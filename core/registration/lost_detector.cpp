// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/lost_detector.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Time between two scans that are kept [ns].
constexpr std::int64_t kSpacingNs = 90'000'000;
// A longer pause between scans: the windows begin anew.
constexpr double kPauseS = 2.5;
// Turn that the gyro has not seen: window, limit, and the part of the limit that comes from gravity's error, with which
// the attitude filter turns roll and pitch.
struct Window {
  double length_s;
  double limit_rad;
  double tilt_sigmas;
};
constexpr std::array<Window, 2> kWindows{{{0.95, 2.5 * kRadPerDeg, 1.0}, {3.95, 4.0 * kRadPerDeg, 1.5}}};
// Share of the gyro's turn: a mount that is off by 1.5 degrees, clocks that are off by 5 ms.
constexpr double kTurnShare = 0.05;
// Tilt against gravity, which accelerations without wheels to tell them pull by 9 degrees.
constexpr double kTiltRad = 12.0 * kRadPerDeg;
constexpr double kTiltSigmas = 4.0;
// Turn of roll and pitch by gravity while a robot without wheels speeds up by 1.2 m/s^2.
constexpr double kGravityTurnRad = 8.0 * kRadPerDeg;
// Scans in a row that must contradict: one may be an outlier.
constexpr int kContradictions = 2;

double turn_rad(const Eigen::Matrix3d& R) { return rotation_angle_rad(Eigen::Quaterniond(R)); }

// Turns from `then` to `now` in axes of base_link: of the gyro, and by how much the registered one differs.
struct Turn {
  double gyro_rad;
  double difference_rad;  // less what gravity may have added
};

Turn turn_between(const LostEvidence& then, const LostEvidence& now) {
  const Eigen::Matrix3d registered = then.T_map_base.linear().transpose() * now.T_map_base.linear();
  const Eigen::Matrix3d gyro = then.T_odom_base.linear().transpose() * now.T_odom_base.linear();
  const Eigen::Vector3d difference_rad = log_so3(Eigen::Quaterniond(registered.transpose() * gyro));
  if (now.on_wheels) return {turn_rad(gyro), difference_rad.norm()};
  const Eigen::Vector3d up_base = now.T_map_base.linear().row(2).transpose();
  const double yaw_rad = std::abs(up_base.dot(difference_rad));
  return {turn_rad(gyro), std::max(yaw_rad, difference_rad.norm() - kGravityTurnRad)};
}

double tilt_rad(const LostEvidence& at) {
  const Eigen::Vector3d by_scan = at.T_map_base.linear().row(2).transpose();
  const Eigen::Vector3d by_gravity = at.T_odom_base.linear().row(2).transpose();
  return std::atan2(by_scan.cross(by_gravity).norm(), by_scan.dot(by_gravity));
}

}  // namespace

LostReason LostDetector::add(const LostEvidence& evidence) {
  if (count_ > 0) {
    const double pause_s = seconds_between(kept_[newest_].stamp_ns, evidence.stamp_ns);
    if (pause_s > kPauseS || pause_s < 0.0) restart();
  }
  const LostEvidence* since = nullptr;
  const LostReason reason = judge(evidence, since);
  contradicted_ = reason == LostReason::kNone ? 0 : contradicted_ + 1;
  if (contradicted_ >= kContradictions) {
    good_ = *since;
    return reason;
  }
  keep(evidence);
  return LostReason::kNone;
}

LostReason LostDetector::judge(const LostEvidence& now, const LostEvidence*& since) const {
  for (const Window& window : kWindows) {
    const LostEvidence* then = before(now.stamp_ns, window.length_s);
    if (then == nullptr) continue;
    const Turn turn = turn_between(*then, now);
    const double limit_rad = window.limit_rad + kTurnShare * turn.gyro_rad +
                             window.tilt_sigmas * now.tilt_sd_rad +
                             now.turn_rate_sd_rad_s * seconds_between(then->stamp_ns, now.stamp_ns);
    since = then;
    if (turn.difference_rad > limit_rad) return LostReason::kTurn;
  }
  if (since == nullptr || tilt_rad(now) < kTiltRad + kTiltSigmas * now.tilt_sd_rad) return LostReason::kNone;
  return LostReason::kTilt;
}

// The newest scan that is older by `age_s` at least; none where it is older by kPauseS more, or was not kept.
const LostEvidence* LostDetector::before(std::int64_t stamp_ns, double age_s) const {
  for (std::size_t i = 0; i < count_; ++i) {
    const LostEvidence& at = kept_[(newest_ + kKept - i) % kKept];
    const double old_s = seconds_between(at.stamp_ns, stamp_ns);
    if (old_s >= age_s) return old_s < age_s + kPauseS ? &at : nullptr;
  }
  return nullptr;
}

void LostDetector::keep(const LostEvidence& evidence) {
  if (count_ > 0 && evidence.stamp_ns - kept_[newest_].stamp_ns < kSpacingNs) return;
  newest_ = count_ > 0 ? (newest_ + 1) % kKept : 0;
  kept_[newest_] = evidence;
  count_ = std::min(count_ + 1, kKept);
}

}  // namespace isobar
