// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that tries a hint of where the robot is.
//
//     hint ─▶ HintTrial: hypotheses around it, a few a scan ─▶ three scans in a row match ─▶ taken
//
// A robot that does not know its place searches around the hint instead of its own search, which goes on where it was when
// nothing matches. A robot that knows its place goes on registering, and tries the hint beside that; it moves only where
// the scan matches clearly better there. Until then a hint changes nothing.
#include <cmath>

#include "core/geometry.hpp"
#include "core/registration/registration.hpp"
#include "core/registration/twist.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Hypotheses that are matched with one scan: of a robot that stands and searches, is lost, or knows its place and has
// been registered with the same scan.
constexpr std::size_t kWhileLost = 4;
constexpr std::size_t kBeside = 2;
// Distance at which two matches are of one place.
constexpr double kSameM = 0.3;
constexpr double kSameRad = 5.0 * kRadPerDeg;
// Share of the scan by which a hint must match better than the present place: people and doors hide less.
constexpr double kClearlyBetter = 0.1;
// Difference between the height of a hint and the robot's: people name the floor, the altimeter knows the height.
constexpr double kHeightAgreesM = 1.5;
constexpr double kHeightSigmas = 3.0;
// Difference of heights from which the altimeter begins anew at the place found.
constexpr double kOtherHeightM = 0.3;

bool are_same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Vector6d between = twist_between(a, b);
  return between.tail<3>().norm() < kSameM && between.head<3>().norm() < kSameRad;
}

}  // namespace

void Registration::hint(const PlaceHint& hint) { state_.hint.offer(hint); }

// Begins the trial of a waiting hint. Roll and pitch are gravity's, the height is the altimeter's where there is one.
void Registration::begin_hint(const MapSnapshot& map, const Prior& end, const Eigen::Isometry3d& T_believed) {
  HintTrial& trial = state_.hint;
  if (trial.is_overdue(end.stamp_ns)) trial.finish(HintOutcome::kNoScan, end.stamp_ns);
  const PlaceHint* hint = trial.waiting();
  if (hint == nullptr) return;
  const Eigen::Vector3d p_believed = T_believed.translation();
  trial.set_distance((hint->p_map_m - p_believed.head<2>()).norm());
  if (hint->session != 0 && hint->session != session()) {
    trial.finish(HintOutcome::kOtherFrame, end.stamp_ns);
    return;
  }
  if (!knows(map)) {
    trial.finish(HintOutcome::kNoMap, end.stamp_ns);
    return;
  }
  const bool has_altimeter = end.height_source != HeightSource::kNone && !hint->z_is_sure;
  const double apart_m = hint->has_z ? std::abs(hint->z_m - p_believed.z()) : 0.0;
  if (has_altimeter && apart_m > kHeightAgreesM + kHeightSigmas * hint->z_sigma_m) {
    trial.finish(HintOutcome::kOtherHeight, end.stamp_ns);
    return;
  }
  Eigen::Isometry3d T_map_base = T_believed;
  T_map_base.linear() = rotation_about_z(hint->yaw_rad - yaw_of(T_believed.linear())) * T_believed.linear();
  T_map_base.translation().head<2>() = hint->p_map_m;
  if (hint->has_z && !has_altimeter) T_map_base.translation().z() = hint->z_m;
  trial.begin(end, T_map_base, state_.lost.matched_overlap, state_.lost.matched_rms_m);
}

// Matches some hypotheses, or the place found, with one scan.
// @param found the match, once it is confirmed
PlaceVerdict Registration::judge_hint(const MapSnapshot& map, const Prior& end, const Prediction& prediction,
                                      std::size_t per_scan, MatchResult& found) {
  HintTrial& trial = state_.hint;
  if (!PlaceSearch::can_judge(sampler_.sample().size())) return PlaceVerdict::kSearching;
  const MethodTraits& traits = traits_of_search(end);
  PlaceSearch& search = trial.search();
  Prediction expected = prediction;
  expected.T_map_base = trial.expected(end);
  if (search.confirming()) {
    found = match(map, end, with_height_error(PlaceSearch::near(expected), end), traits);
    const PlaceVerdict verdict = search.confirm(expected, found);
    if (search.fits(expected, found)) trial.move_to(end, found.T_map_base);
    return verdict;
  }
  for (std::size_t i = 0; i < per_scan; ++i) {
    search.judge(expected, match(map, end, with_height_error(search.next(expected), end), traits));
  }
  const PlaceVerdict verdict = search.end_of_scan();
  if (verdict == PlaceVerdict::kFound) trial.move_to(end, search.correction() * expected.T_map_base);
  return verdict;
}

// Of a robot that does not know its place. The caller has written what it knows of the pose.
void Registration::search_hint(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                               RegisteredScan& out) {
  PoseEstimate& pose = out.pose;
  MatchResult found;
  state_.motion.keep_prediction(end, expected);
  const std::size_t per_scan = lost() ? kWhileLost : PlaceSearch::kPerScan;
  const PlaceVerdict verdict = judge_hint(map, end, expected, per_scan, found);
  if (verdict == PlaceVerdict::kUnknown) state_.hint.finish(HintOutcome::kNoMatch, end.stamp_ns);
  if (verdict == PlaceVerdict::kConfirmed) {
    const bool was_lost = lost();
    go_on_from(end, found, pose);
    if (was_lost) find_again(pose);
    pose.for_map = false;
    state_.search.stop();
  }
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  state_.last = pose;
}

// Of a robot that knows its place, or believes so, after the registration of the scan.
void Registration::try_hint_beside(const MapSnapshot& map, const Prior& end, const Prediction& prediction,
                                   PoseEstimate& pose) {
  begin_hint(map, end, pose.T_map_base);
  if (!state_.hint.active()) return;
  MatchResult found;
  const PlaceVerdict verdict = judge_hint(map, end, prediction, kBeside, found);
  // Where the robot may have been carried away, the map around it holds its own scans, which have cleared what they saw
  // through: nothing is to be compared.
  const bool compares = pose.mode == PoseMode::kRegistered && !state_.hint.present_is_doubtful(end.stamp_ns);
  if (verdict == PlaceVerdict::kUnknown) {
    state_.hint.finish(HintOutcome::kNoMatch, end.stamp_ns);
  } else if (verdict == PlaceVerdict::kConfirmed && are_same(found.T_map_base, pose.T_map_base)) {
    state_.hint.finish(HintOutcome::kConfirmed, end.stamp_ns);
  } else if (verdict == PlaceVerdict::kConfirmed && compares &&
             found.overlap < pose.overlap + kClearlyBetter) {
    state_.hint.finish(HintOutcome::kPresentFits, end.stamp_ns);
  } else if (verdict == PlaceVerdict::kConfirmed) {
    go_on_from(end, found, pose);
    pose.for_map = false;
    state_.last = pose;
  }
}

// The robot is at the match: whatever was learnt from its motion through the map begins anew there.
void Registration::go_on_from(const Prior& end, const MatchResult& found, PoseEstimate& pose) {
  const double climb_m = found.T_map_base.translation().z() - pose.T_map_base.translation().z();
  state_.hint.finish(HintOutcome::kFound, end.stamp_ns);
  state_.motion.relocate(end, found.T_map_base);
  state_.speed.stop();
  state_.awaits_place = state_.place_given_up = false;
  state_.bootstrapping = false;
  state_.lost_detector.restart();
  if (std::abs(climb_m) > kOtherHeightM) state_.height.restart();
  restart_drift(end);
  state_.drift.restart_at(found.T_map_base.translation());
  copy_statistics(found, pose);
  pose.mode = PoseMode::kRegistered;
  pose.T_map_base = found.T_map_base;
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  pose.covariance = as_pose_covariance(found.twist_covariance);
}

}  // namespace isobar
