// SPDX-License-Identifier: BSD-3-Clause
// The part of Registration for robots without wheels: the speed of a run that begins in motion (SpeedSearch), and turns
// that no gyro has felt.
#include "core/geometry.hpp"
#include "core/registration/registration.hpp"
#include "core/registration/scan_preparation.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Turn and step of a scan beyond the prediction from which it is deskewed again, by what it has shown, and how often: each
// time the rest is halved.
constexpr double kTurnRad = 0.3 * kRadPerDeg;
constexpr double kStepM = 0.03;
constexpr int kPasses = 4;
// A gap between scans, over which a rate says nothing [s].
constexpr double kTurnGapS = 0.3;
// Speed that the search may find [m/s], 1 sigma.
constexpr double kSearchedSpeedMS = 6.0;

}  // namespace

// The scan has been deskewed as the first one was: at a constant velocity both have one shape, whatever the velocity.
// @return true while the speed is unknown: the scan has no place. Else the prediction is by the speed
bool Registration::search_speed(const MapSnapshot& map, const Prior& end, const MethodTraits& traits,
                                Prediction& prediction, PoseEstimate& pose) {
  SpeedSearch& search = state_.speed;
  if (search.done() || !traits.registers() || !state_.motion.speed_unknown(end) || !knows(map)) return false;
  const Eigen::Vector3d p_first = prediction.T_map_base.translation();
  const double after_s = state_.motion.travel_s(end);
  Prediction predicted = prediction;
  for (std::size_t i = 0; i < SpeedSearch::kHypotheses; ++i) {
    predicted.T_map_base.translation().head<2>() = p_first.head<2>() + search.velocity_m_s(i) * after_s;
    const MatchResult result = match(map, end, predicted, traits);
    search.add(i, result, (result.T_map_base.translation() - p_first).head<2>(), after_s);
  }
  search.end_scan();
  if (!search.done()) {
    wait_for_speed(prediction, after_s, pose);
    return true;
  }
  prediction.T_map_base.translation().head<2>() += search.best_m_s() * after_s;
  prediction.T_map_odom = prediction.T_map_base * end.T_odom_base.inverse();
  return false;
}

void Registration::wait_for_speed(const Prediction& standing, double after_s, PoseEstimate& pose) {
  pose.mode = PoseMode::kInitializing;
  pose.T_map_base = standing.T_map_base;
  pose.T_map_odom = standing.T_map_odom;
  pose.covariance = state_.last.covariance;
  pose.covariance.topLeftCorner<2, 2>().diagonal().array() += squared(kSearchedSpeedMS * after_s);
  pose.for_map = false;
  state_.last = pose;
}

// A scan during which a turn begins was deskewed as if there were none, and shows half of it. Where neither gyro nor wheels
// know the turn, it is deskewed again by what it has shown.
MatchResult Registration::match_by_own_motion(const Scan& scan, const MapSnapshot& map, const Prior& end,
                                              const MethodTraits& traits, const Prediction& prediction,
                                              RegisteredScan& out) {
  MatchResult result = match(map, end, prediction, traits);
  if (state_.motion.turn_known(end) || state_.motion.travel_s(end) > kTurnGapS) return result;
  Prediction by_scan = prediction;
  for (int pass = 1; pass < kPasses && result.solved; ++pass) {
    const Vector6d shown = twist_between(by_scan.T_map_base, result.T_map_base);
    if (shown.head<3>().norm() < kTurnRad && shown.tail<3>().norm() < kStepM) break;
    by_scan.T_map_base = result.T_map_base;
    prepare_scan(scan, state_.history, state_.motion.motion_towards(end, by_scan.T_map_base), deskewer_,
                 sampler_, out);
    result = match(map, end, by_scan, traits);
  }
  return result;
}

}  // namespace isobar
