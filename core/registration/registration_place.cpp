// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that begins a map frame or continues in a known one.
#include <algorithm>
#include <cmath>

#include "core/registration/registration.hpp"
#include "core/registration/unseen_motion.hpp"
#include "core/short_pause.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Time for which the search waits for the height, which continues with the base station's pressure: after a short
// pause, and after a longer one, in which the robot may have been taken to another floor (prior_motion.cpp).
constexpr double kWaitForHeightS = 2.5;
constexpr double kWaitForBaseS = 11.0;
// Standard deviation of a pose that no scan has confirmed.
constexpr double kUnknownM = 10.0;
constexpr double kUnknownRad = 3.0;
// Largest error of the height in which the scans are searched, 1 sigma.
constexpr double kLargestHeightErrorM = 0.5;

Matrix6d unknown_covariance() {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(kUnknownM * kUnknownM);
  covariance.diagonal().tail<3>().setConstant(kUnknownRad * kUnknownRad);
  return covariance;
}

// Covariance of a robot that stood, and that no scan confirms.
Matrix6d covariance_of_unseen(const Prior& prior) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<2>().setConstant(squared(kStoodM));
  covariance(2, 2) = std::max(prior.height_variance_m2, squared(kStoodM));
  covariance.diagonal().segment<2>(3).setConstant(prior.roll_pitch_variance_rad2);
  covariance(5, 5) = squared(kStoodRad);
  return covariance;
}

}  // namespace

// The height of the start is known less well than the one of a run.
Prediction Registration::with_height_error(Prediction prediction, const Prior& prior) {
  const double height_sd_m = std::sqrt(std::max(prior.height_variance_m2, 0.0));
  prediction.deviation(5) = std::max(prediction.deviation(5), std::min(height_sd_m, kLargestHeightErrorM));
  return prediction;
}

// The scans find z as well, near the altimeter's height: a robot that was killed on stairs, in an elevator or on a
// rope has climbed unseen.
const MethodTraits& Registration::traits_of_search(const Prior& prior) const {
  const MethodTraits& traits = traits_for(prior);
  return traits.method == Method::k3Dof ? traits_of_free_height_ : traits;
}

void Registration::resume(const KnownPlace& place) {
  state_.place = place;
  state_.last.session = place.session;
  state_.last.T_map_base = place.T_map_base;
  state_.last.covariance = unknown_covariance();
}

// A map that was moved takes the robot along: what is known of its pose and of the altimeter goes on in it.
void Registration::follow_map(const MapSnapshot& map) {
  if (map.session() != session() || map.move().number == state_.map_move.number) return;
  const Eigen::Isometry3d T = map.move().since(state_.map_move);
  state_.map_move = map.move();
  state_.last.map_moves = map.move().number;
  state_.last.T_map_base = T * state_.last.T_map_base;
  state_.last.T_map_odom = T * state_.last.T_map_odom;
  if (state_.motion.started()) state_.motion.follow_map(T);
  state_.height.follow_map(T.translation().z());
  if (state_.place) state_.place->T_map_base = T * state_.place->T_map_base;
  state_.lost.T_map_base = T * state_.lost.T_map_base;
  state_.hint.follow_map(T);
  state_.halt.leave();
  state_.lost_detector.restart();
}

void Registration::begin_new_frame() {
  const std::uint32_t before = session();
  next_frame();
  if (state_.home) {
    resume(*state_.home);
    state_.last.session = before;
  }
  state_.history.clear();
  state_.height.restart_clock();
  state_.first_prior_ns = 0;
}

void Registration::next_frame() {
  PoseEstimate blank;
  blank.stamp_ns = state_.last.stamp_ns;
  blank.sequence = state_.last.sequence;
  blank.session = session() + 1;
  blank.method = asked_;
  state_.last = blank;
  state_.map_move = {};
  state_.motion = MotionModel(config_);
  state_.search.stop();
  if (state_.hint.active()) state_.hint.finish(HintOutcome::kOtherFrame, blank.stamp_ns);
  state_.speed.restart();
  state_.lost_detector.restart();
  state_.lost = {};
  state_.ground_since_ns = 0;
  state_.risen_variance_m2 = 0.0;
  state_.place.reset();
  state_.awaits_place = state_.place_given_up = false;
  state_.scans_without_gravity = state_.bootstrap_scans = 0;
  state_.level_since_ns = 0;
  state_.bootstrapping = true;
}

bool Registration::start_at_place(const Prior& prior) {
  // The whole map tells the place, and the scans after it the speed.
  state_.speed.stop();
  const bool waits = state_.place->has_height && prior.height_source == HeightSource::kNone;
  const double waited_s = seconds_between(state_.first_prior_ns, prior.stamp_ns);
  const bool short_pause = is_short_pause(seconds_between(state_.place->stamp_ns, prior.stamp_ns));
  if (waits && waited_s < (short_pause ? kWaitForHeightS : kWaitForBaseS)) return false;
  const KnownPlace& place = *state_.place;
  ExpectedPlace expected = expected_place(place, state_.history);
  if (place.has_height && prior.height_source != HeightSource::kNone) {
    expected.T_map_base.translation().z() =
        place.T_map_base.translation().z() + (prior.height_m - place.height_m);
  }
  state_.motion.start_at(prior, expected.T_map_base);
  state_.height.restart();
  state_.tilt.restart();
  restart_drift(prior);
  state_.drift.restart_at(expected.T_map_base.translation());
  state_.awaits_place = place.anywhere;
  if (!place.anywhere) state_.search.begin(place, seconds_between(place.stamp_ns, prior.stamp_ns), expected);
  state_.place.reset();
  return true;
}

// The robot drives on by dead reckoning until somebody has found its place in the whole map, or has given it up.
void Registration::await_place(const Prior& end, const Prediction& expected, PoseEstimate& pose) {
  state_.motion.keep_prediction(end, expected);
  if (state_.place_given_up) leave_unknown_place(pose);
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  state_.last = pose;
}

void Registration::leave_unknown_place(PoseEstimate& pose) {
  next_frame();
  pose.session = session();
  pose.T_map_base.setIdentity();
}

// Searches the place with one scan. Its points stay out of the map: they are for a search of the whole one.
void Registration::search_place(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                                RegisteredScan& out) {
  const MethodTraits& traits = traits_of_search(end);
  PoseEstimate& pose = out.pose;
  pose.for_map = false;
  pose.T_map_base = expected.T_map_base;
  pose.covariance = unknown_covariance();
  begin_hint(map, end, expected.T_map_base);
  if (state_.hint.active()) {
    search_hint(map, end, expected, out);
    return;
  }
  if (state_.awaits_place || state_.place_given_up) {
    await_place(end, expected, pose);
    return;
  }
  // A dropped scan has no points.
  if (!PlaceSearch::can_judge(sampler_.sample().size())) {
    state_.motion.keep_prediction(end, expected);
    pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
    state_.last = pose;
    return;
  }
  const PlaceVerdict verdict = state_.search.confirming()
                                   ? confirm_place(map, end, expected, traits, pose)
                                   : try_hypotheses(map, end, expected, traits, PlaceSearch::kPerScan);
  if (verdict == PlaceVerdict::kUnknown && state_.waits_for_place) {
    state_.search.stop();
    state_.awaits_place = true;
  } else if (verdict == PlaceVerdict::kUnknown) {
    leave_unknown_place(pose);
  }
  if (verdict == PlaceVerdict::kUnseen) {
    pose.mode = PoseMode::kPriorOnly;
    pose.covariance = covariance_of_unseen(end);
  }
  if (verdict == PlaceVerdict::kConfirmed || verdict == PlaceVerdict::kUnseen) {
    state_.search.stop();
    state_.bootstrapping = false;
    if (verdict == PlaceVerdict::kConfirmed) pose.mode = PoseMode::kRegistered;
    out.point_count = 0;
    pose.for_map = true;
  }
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  state_.last = pose;
}

PlaceVerdict Registration::try_hypotheses(const MapSnapshot& map, const Prior& end,
                                          const Prediction& expected, const MethodTraits& traits,
                                          std::size_t per_scan) {
  PlaceSearch& search = state_.search;
  for (std::size_t i = 0; i < per_scan; ++i) {
    const Prediction hypothesis = with_height_error(search.next(expected), end);
    search.judge(expected, knows(map) ? match(map, end, hypothesis, traits) : MatchResult{});
  }
  const PlaceVerdict verdict = search.end_of_scan();
  if (verdict == PlaceVerdict::kFound) {
    state_.motion.relocate(end, search.correction() * expected.T_map_base);
  } else {
    state_.motion.keep_prediction(end, expected);
  }
  return verdict;
}

PlaceVerdict Registration::confirm_place(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                                         const MethodTraits& traits, PoseEstimate& pose) {
  const MatchResult result =
      knows(map) ? match(map, end, with_height_error(PlaceSearch::near(expected), end), traits)
                 : MatchResult{};
  const PlaceVerdict verdict = state_.search.confirm(expected, result);
  if (!state_.search.fits(expected, result)) {
    state_.motion.keep_prediction(end, expected);
    return verdict;
  }
  state_.motion.correct(end, result.T_map_base);
  copy_statistics(result, pose);
  pose.T_map_base = result.T_map_base;
  if (verdict == PlaceVerdict::kConfirmed) pose.covariance = as_pose_covariance(result.twist_covariance);
  return verdict;
}

}  // namespace isobar
