// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration that begins a map frame or continues in a known one.
#include "core/registration/registration.hpp"

namespace isobar {

namespace {

// Scans for which the search waits for the height, which continues with the base station's pressure.
constexpr std::uint32_t kMaxScansWithoutHeight = 25;
// Standard deviation of a pose that no scan has confirmed.
constexpr double kUnknownM = 10.0;
constexpr double kUnknownRad = 3.0;

Matrix6d unknown_covariance() {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(kUnknownM * kUnknownM);
  covariance.diagonal().tail<3>().setConstant(kUnknownRad * kUnknownRad);
  return covariance;
}

}  // namespace

void Registration::resume(const KnownPlace& place) {
  state_.place = place;
  state_.last.session = place.session;
  state_.last.T_map_base = place.T_map_base;
  state_.last.covariance = unknown_covariance();
}

void Registration::begin_new_frame() {
  next_frame();
  state_.history.clear();
}

void Registration::next_frame() {
  PoseEstimate blank;
  blank.stamp_ns = state_.last.stamp_ns;
  blank.sequence = state_.last.sequence;
  blank.session = session() + 1;
  blank.method = asked_;
  state_.last = blank;
  state_.motion = MotionModel(config_);
  state_.search.stop();
  state_.place.reset();
  state_.scans_without_gravity = state_.scans_without_height = state_.bootstrap_scans = 0;
  state_.bootstrapping = true;
}

bool Registration::start_at_place(const Prior& prior) {
  const bool waits = state_.place->has_height && prior.height_source == HeightSource::kNone;
  if (waits && ++state_.scans_without_height < kMaxScansWithoutHeight) return false;
  state_.motion.start_at(prior, PlaceSearch::expected_pose(*state_.place, prior.stamp_ns));
  state_.search.begin(*state_.place, prior.stamp_ns);
  state_.place.reset();
  return true;
}

// Searches the place with one scan. Its points stay out of the map.
void Registration::search_place(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                                const MethodTraits& traits, RegisteredScan& out) {
  PoseEstimate& pose = out.pose;
  out.point_count = 0;
  pose.T_map_base = expected.T_map_base;
  pose.covariance = unknown_covariance();
  // A dropped scan has no points and says nothing about the place.
  if (sampler_.sample().empty()) {
    state_.motion.keep_prediction(end, expected);
    pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
    state_.last = pose;
    return;
  }
  const PlaceVerdict verdict = state_.search.confirming() ? confirm_place(map, end, expected, traits, pose)
                                                          : try_hypotheses(map, end, expected, traits);
  if (verdict == PlaceVerdict::kUnknown) {
    next_frame();
    pose.session = session();
    pose.T_map_base.setIdentity();
  }
  if (verdict == PlaceVerdict::kConfirmed) {
    state_.search.stop();
    state_.bootstrapping = false;
    pose.mode = PoseMode::kRegistered;
  }
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  state_.last = pose;
}

PlaceVerdict Registration::try_hypotheses(const MapSnapshot& map, const Prior& end,
                                          const Prediction& expected, const MethodTraits& traits) {
  PlaceSearch& search = state_.search;
  for (std::size_t i = 0; i < PlaceSearch::kPerScan; ++i) {
    const Prediction hypothesis = search.next(expected);
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
      knows(map) ? match(map, end, PlaceSearch::near(expected), traits) : MatchResult{};
  const PlaceVerdict verdict = state_.search.confirm(result);
  if (!state_.search.fits(result)) {
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
