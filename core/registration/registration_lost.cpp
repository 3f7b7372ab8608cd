// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that notices that it is lost, says so, and finds its place again.
//
//     registered pose ─▶ LostDetector ─▶ lost: dead reckoning from before the contradiction ─▶ PlaceSearch ─▶ found
#include <algorithm>
#include <cmath>

#include "core/pose_carrying.hpp"
#include "core/registration/halt.hpp"
#include "core/registration/registration.hpp"
#include "core/registration/twist.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Gain of the mean of overlap and residual of the scans before.
constexpr double kMatchGain = 0.05;
// Position error of a pose from before a contradiction, 1 sigma: half of what has been noticed may be older.
constexpr double kRolledBackM = 0.2;
constexpr double kRolledBackRad = 1.0 * kRadPerDeg;
// Dead reckoning while lost: share of the way on wheels; speed of a robot without wheels, 1 sigma.
constexpr double kWayShare = 0.1;
constexpr double kUnseenSpeedMS = 0.5;
// A place found again agrees with gravity and with the gyro up to this, and their own errors.
constexpr double kAgreesRad = 5.0 * kRadPerDeg;
constexpr double kAgreesSigmas = 3.0;
// Age that makes the search strict: what matches must match as well as before.
constexpr double kStrictPauseS = 1000.0;
// Hypotheses that are matched with one scan: a robot may stay lost for long, and its scans keep coming.
constexpr std::size_t kHypotheses = 2;

}  // namespace

// z of the methods that ask no altimeter, on moving ground: scans of a cabin show no ride. The prior's height does; what
// it gains carries the pose, and no scan is registered.
void Registration::rise_with_ground(const Prior& end, const MethodTraits& traits, Prediction& prediction) {
  const bool asks_none = traits.method != Method::kAdaptive && traits.height == Constraint::kFree &&
                         traits.registers() && end.height_source != HeightSource::kNone;
  const bool rode = state_.ground_since_ns != 0;
  const bool rides = asks_none && end.ground_moves && (rode || wheels_stand(end));
  if (rides && !rode && !config_.has_imu) state_.scan_height_m = height_before_ride(end.stamp_ns);
  if (rides || rode) {
    const Eigen::Vector3d up(0.0, 0.0, end.height_m - state_.scan_height_m);
    prediction.T_map_base.pretranslate(up);
    prediction.T_map_odom.pretranslate(up);
  }
  if (rode && !rides) state_.risen_variance_m2 += 2.0 * end.height_variance_m2;
  if (rode != rides) state_.ground_since_ns = rides ? end.stamp_ns : 0;
  state_.scan_height_m = end.height_m;
}

// Air alone shows a ride late (AirRide): the height at rest is that of some seconds ago.
double Registration::height_before_ride(std::int64_t stamp_ns) const {
  constexpr std::int64_t kLateNs = 4'000'000'000;
  constexpr std::int64_t kMeanNs = 1'000'000'000;
  double sum_m = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < state_.history.size(); ++i) {
    const Prior& prior = state_.history[i];
    if (prior.stamp_ns < stamp_ns - kLateNs - kMeanNs || prior.stamp_ns > stamp_ns - kLateNs) continue;
    sum_m += prior.height_m;
    count += 1.0;
  }
  return count > 0.0 ? sum_m / count : state_.scan_height_m;
}

void Registration::describe_ground(const Prior& end, PoseEstimate& pose) const {
  pose.covariance(2, 2) += state_.risen_variance_m2;
  if (state_.ground_since_ns == 0) return;
  pose.lost = LostReason::kMovingGround;
  pose.lost_since_ns = state_.ground_since_ns;
  pose.covariance(2, 2) += 2.0 * end.height_variance_m2;
}

// Judges a registered pose; where it contradicts the other sensors, replaces it.
void Registration::watch(const Prior& end, PoseEstimate& pose) {
  if (!end.attitude_valid) return;
  LostEvidence evidence;
  evidence.stamp_ns = end.stamp_ns;
  evidence.T_map_base = pose.T_map_base;
  evidence.T_odom_base = end.T_odom_base;
  evidence.tilt_sd_rad = std::sqrt(std::max(0.0, end.roll_pitch_variance_rad2));
  evidence.turn_rate_sd_rad_s = std::sqrt(std::max(0.0, end.yaw_rate_variance_rad2_s2));
  evidence.on_wheels = end.velocity_valid;
  const LostReason reason = state_.lost_detector.add(evidence);
  if (reason != LostReason::kNone) {
    begin_lost(end, reason, pose);
    return;
  }
  LostState& before = state_.lost;
  state_.hint.watch(end.stamp_ns, pose.overlap, before.matched_overlap);
  const double gain = before.matched_overlap > 0.0 ? kMatchGain : 1.0;
  before.matched_overlap += gain * (pose.overlap - before.matched_overlap);
  before.matched_rms_m += gain * (pose.residual_rms_m - before.matched_rms_m);
}

void Registration::begin_lost(const Prior& end, LostReason reason, PoseEstimate& pose) {
  const LostEvidence& good = state_.lost_detector.last_good();
  LostState& lost = state_.lost;
  lost.reason = reason;
  lost.since_ns = end.stamp_ns;
  lost.T_odom_base = end.T_odom_base;
  lost.has_height = end.height_source != HeightSource::kNone;
  lost.height_m = end.height_m;
  lost.T_map_base = PoseAnchor(good.T_map_base, good.T_odom_base).carried_to(end.T_odom_base);
  // Without wheels dead reckoning knows no way: the scans' is the better one.
  if (!end.velocity_valid) lost.T_map_base.translation() = pose.T_map_base.translation();
  const Vector6d wrong = twist_between(pose.T_map_base, lost.T_map_base);
  lost.error_rad = std::hypot(kRolledBackRad, 0.5 * wrong.head<3>().norm());
  lost.error_m = std::hypot(kRolledBackM, wrong.tail<3>().norm());
  search_around(end);
  pose.mode = PoseMode::kPriorOnly;
  pose.T_map_base = lost.T_map_base;
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  describe_lost(end, pose);
}

Eigen::Isometry3d Registration::dead_reckoned(const Prior& end) const {
  const LostState& lost = state_.lost;
  Eigen::Isometry3d T_map_base = PoseAnchor(lost.T_map_base, lost.T_odom_base).carried_to(end.T_odom_base);
  if (lost.has_height) {
    T_map_base.translation().z() = lost.T_map_base.translation().z() + end.height_m - lost.height_m;
  }
  return T_map_base;
}

void Registration::search_around(const Prior& end) {
  KnownPlace place;
  place.session = session();
  place.stamp_ns = end.stamp_ns;
  place.T_map_base = dead_reckoned(end);
  place.overlap = state_.lost.matched_overlap;
  place.residual_rms_m = state_.lost.matched_rms_m;
  ExpectedPlace expected;
  expected.T_map_base = place.T_map_base;
  expected.unseen_m = kUnseenSpeedMS * seconds_between(state_.lost.since_ns, end.stamp_ns);
  state_.motion.relocate(end, place.T_map_base);
  state_.search.begin(place, kStrictPauseS, expected);
}

// Says that the robot is lost, and how wrong its dead reckoning may be.
void Registration::describe_lost(const Prior& end, PoseEstimate& pose) const {
  const LostState& lost = state_.lost;
  const double lost_s = seconds_between(lost.since_ns, end.stamp_ns);
  const double way_m = (end.T_odom_base.translation() - lost.T_odom_base.translation()).norm();
  const double drift_m = end.velocity_valid ? kWayShare * way_m : kUnseenSpeedMS * lost_s;
  const double turn_m2 = end.yaw_rate_variance_rad2_s2 * squared(lost_s);
  pose.lost = lost.reason;
  pose.lost_since_ns = lost.since_ns;
  pose.for_map = false;
  pose.covariance.setZero();
  pose.covariance.diagonal().head<3>().setConstant(squared(lost.error_m) + squared(drift_m));
  if (lost.has_height) pose.covariance(2, 2) = squared(lost.error_m) + 2.0 * end.height_variance_m2;
  pose.covariance.diagonal().segment<2>(3).setConstant(squared(lost.error_rad) +
                                                       end.roll_pitch_variance_rad2);
  pose.covariance(5, 5) = squared(lost.error_rad) + turn_m2;
  pose.covariance += state_.drift.covariance();
}

void Registration::search_lost(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                               RegisteredScan& out) {
  const MethodTraits& traits = traits_of_search(end);
  PoseEstimate& pose = out.pose;
  pose.mode = PoseMode::kPriorOnly;
  pose.T_map_base = dead_reckoned(end);
  describe_lost(end, pose);
  begin_hint(map, end, pose.T_map_base);
  if (state_.hint.active()) {
    search_hint(map, end, expected, out);
    return;
  }
  if (!PlaceSearch::can_judge(sampler_.sample().size())) {
    state_.motion.keep_prediction(end, expected);
  } else if (state_.search.confirming()) {
    const PlaceVerdict verdict = confirm_place(map, end, expected, traits, pose);
    const bool agrees = plausible(end, pose.T_map_base);
    if (verdict == PlaceVerdict::kConfirmed && agrees) {
      find_again(pose);
    } else {
      pose.T_map_base = dead_reckoned(end);
      describe_lost(end, pose);
      if (verdict != PlaceVerdict::kFound || !agrees) search_around(end);
    }
  } else if (try_hypotheses(map, end, expected, traits, kHypotheses) == PlaceVerdict::kUnknown) {
    search_around(end);
  }
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  state_.last = pose;
}

// Gravity and the gyro since the start of being lost know the attitude.
bool Registration::plausible(const Prior& end, const Eigen::Isometry3d& T_map_base) const {
  const Eigen::Matrix3d difference = T_map_base.linear() * dead_reckoned(end).linear().transpose();
  const double lost_s = seconds_between(state_.lost.since_ns, end.stamp_ns);
  const double sd_rad = std::sqrt(squared(state_.lost.error_rad) + end.roll_pitch_variance_rad2 +
                                  end.yaw_rate_variance_rad2_s2 * squared(lost_s));
  return rotation_angle_rad(Eigen::Quaterniond(difference)) < kAgreesRad + kAgreesSigmas * sd_rad;
}

void Registration::find_again(PoseEstimate& pose) {
  state_.search.stop();
  state_.lost.reason = LostReason::kNone;
  state_.lost.since_ns = 0;
  state_.lost_detector.restart();
  pose.mode = PoseMode::kRegistered;
  pose.lost = LostReason::kNone;
  pose.lost_since_ns = 0;
  pose.for_map = true;
}

}  // namespace isobar
