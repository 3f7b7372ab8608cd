// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/registration.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/registration/twist.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Number of scans for which the start of the map waits for a valid attitude (gravity); then it starts
// without.
constexpr std::uint32_t kMaxScansWithoutGravity = 30;
// Bootstrap scans before registration must succeed: they enter the map at the predicted pose.
constexpr std::uint32_t kMaxBootstrapScans = 20;
// Pairs below this multiple of the least number must fit: fragments of a revolution find planes anywhere. Rough ground has
// residuals of 0.1 m at most.
constexpr std::size_t kFewFactor = 3;
constexpr double kScatteredM = 0.12;

}  // namespace

Registration::Registration(const RegistrationConfig& config, Method method,
                           const Eigen::Isometry3d& T_base_lidar)
    : config_(config),
      asked_(method),
      T_base_lidar_(T_base_lidar),
      traits_(traits_of(method, HeightSource::kNone)),
      traits_with_height_(traits_of(method, HeightSource::kDifferential)),
      traits_of_free_height_(traits_of(Method::k4DofAltitude, HeightSource::kDifferential)),
      traits_without_imu_(traits_of(Method::k6Dof, HeightSource::kNone)),
      state_(config, Eigen::Quaterniond(T_base_lidar.linear())),
      deskewer_(T_base_lidar, config.min_range_m, config.max_range_m),
      sampler_(config.map_voxel_m, config.sample_points),
      level_(T_base_lidar.translation()),
      matcher_(config, T_base_lidar.translation()) {
  state_.last.method = method;
}

void Registration::take_over(const Registration& other) {
  MotionModel motion = state_.motion;
  motion.take_over(other.state_.motion);
  state_ = other.state_;  // rings of one length
  state_.motion = motion;
}

void Registration::add_prior(const Prior& prior) {
  if (state_.first_prior_ns == 0) state_.first_prior_ns = prior.stamp_ns;
  state_.history.add(prior);
}

bool Registration::ready(const Scan& scan) const {
  return !state_.history.empty() && state_.history.newest().stamp_ns >= scan.end_stamp_ns;
}

const MethodTraits& Registration::traits_for(const Prior& prior) const {
  if (!prior.attitude_valid && traits_.registers() && state_.motion.started()) {
    return traits_without_imu_;
  }
  return prior.height_source == HeightSource::kNone ? traits_ : traits_with_height_;
}

PoseEstimate Registration::description_of(const Prior& prior, const MethodTraits& traits) const {
  PoseEstimate pose;
  pose.stamp_ns = prior.stamp_ns;
  pose.sequence = state_.last.sequence;
  pose.session = session();
  pose.map_moves = state_.map_move.number;
  pose.method = asked_;
  pose.effective_method = traits.method;
  pose.height_source = prior.height_source;
  pose.altimeter = state_.last.altimeter;
  pose.mount = state_.last.mount;
  return pose;
}

Prior Registration::prior_at(std::int64_t stamp_ns) const {
  Prior prior;
  const bool known = state_.history.dense_at(stamp_ns) && state_.history.at(stamp_ns, prior);
  return known ? prior : prior_without_imu(stamp_ns);
}

Prior Registration::prior_without_imu(std::int64_t stamp_ns) const {
  Prior prior;
  if (!state_.history.at(stamp_ns, prior)) {
    prior = stamp_ns < state_.history.oldest().stamp_ns ? state_.history.oldest() : state_.history.newest();
    prior.stamp_ns = stamp_ns;
  }
  prior.attitude_valid = false;
  prior.velocity_valid = false;
  prior.standing_still = false;
  return prior;
}

// False while the map waits for gravity, or a known place for the height.
bool Registration::start_motion(const Scan& scan, const Prior& prior, RegisteredScan& out) {
  if (state_.motion.started()) return true;
  const bool waits_for_gravity = config_.has_imu && !prior.attitude_valid;
  if (waits_for_gravity && ++state_.scans_without_gravity < kMaxScansWithoutGravity) return false;
  if (state_.place) return start_at_place(prior);
  if (traits_.method != Method::kAdaptive) {
    state_.motion.start(prior);
    restart_drift(prior);
    return true;
  }
  if (!find_level(scan, prior, out)) return false;
  state_.height.restart();
  restart_drift(prior);
  return true;
}

void Registration::register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out) {
  PoseEstimate& pose = out.pose;
  out.point_count = 0;
  if (state_.history.empty()) {
    state_.last.stamp_ns = scan.end_stamp_ns;
    pose = state_.last;
    return;
  }
  follow_map(map);
  const Prior end = prior_at(scan.end_stamp_ns);
  pose = description_of(end, traits_for(end));
  pose.sequence = scan.sequence;
  if (!start_motion(scan, end, out)) {
    pose.T_map_base = state_.last.T_map_base;
    pose.covariance = state_.last.covariance;
    state_.last = pose;
    return;
  }
  const MethodTraits& traits = traits_for(end);
  if (traits.method == Method::kAdaptive) use_mount();
  Prediction prediction = predict(end, traits);
  rise_with_ground(end, traits, prediction);
  prepare_scan(scan, state_.history, state_.motion.scan_motion(end, prediction), deskewer_, sampler_, out);
  if (state_.search.active() || state_.awaits_place) {
    lost() ? search_lost(map, end, prediction, out) : search_place(map, end, prediction, out);
    return;
  }
  if (search_speed(map, end, traits, prediction, pose)) return;

  const bool riding =
      traits.method == Method::kAdaptive ? state_.height.riding() : state_.ground_since_ns != 0;
  MatchResult result;
  if (knows(map) && !riding) result = match_by_own_motion(scan, map, end, traits, prediction, out);
  const bool registered = result.solved && acceptable(result, prediction);
  copy_statistics(result, pose);
  pose.mode = mode_after(registered, traits);
  pose.T_map_base = registered ? registered_pose(end, traits, result) : prediction.T_map_base;
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  pose.covariance = as_pose_covariance(result.twist_covariance);

  pose.for_map = !riding && state_.held.for_map(end.standing_still);
  learn(end, prediction, traits, registered, pose);
  own_covariance(end, traits, registered, pose);
  if (traits.method != Method::kAdaptive) describe_ground(end, pose);
  if (registered) watch(end, pose);
  continue_from(end, prediction, registered, pose);
  if (!riding && !lost()) try_hint_beside(map, end, prediction, pose);
}

// The start of the next prediction. A scan with neither registration nor IMU nor wheels does not become it: the scan
// before it stays the start.
void Registration::continue_from(const Prior& end, const Prediction& prediction, bool registered,
                                 const PoseEstimate& pose) {
  state_.last = pose;
  if (lost()) return;  // the search has taken over
  if (registered) {
    state_.motion.correct(end, pose.T_map_base);
  } else if (end.attitude_valid || end.velocity_valid) {
    state_.motion.keep_prediction(end, prediction);
  }
}

MatchResult Registration::match(const MapSnapshot& map, const Prior& prior, const Prediction& prediction,
                                const MethodTraits& traits) {
  if (!traits.registers()) return {};
  return matcher_.match({.map = map,
                         .p_base = sampler_.sample(),
                         .traits = traits,
                         .prediction = prediction,
                         .height_variance_m2 = prior.height_variance_m2});
}

Eigen::Isometry3d Registration::registered_pose(const Prior& end, const MethodTraits& traits,
                                                const MatchResult& result) {
  const Eigen::Isometry3d& T_held = state_.motion.T_map_base();
  // A height that follows the altimeter does so at rest as well.
  const bool held =
      !traits.follows_altimeter() && state_.held.holds(end.may_stand, T_held, result.T_map_base);
  return held ? T_held : result.T_map_base;
}

PoseMode Registration::mode_after(bool registered, const MethodTraits& traits) {
  // Bootstrap: until the first success scans enter the map at the predicted pose. The first revolution may be
  // incomplete, and one scan may cover too little of the place.
  state_.bootstrapping = state_.bootstrapping && !registered && traits.registers() &&
                         state_.bootstrap_scans++ < kMaxBootstrapScans;
  if (registered) return PoseMode::kRegistered;
  return state_.bootstrapping ? PoseMode::kInitializing : PoseMode::kPriorOnly;
}

bool Registration::acceptable(const MatchResult& match, const Prediction& prediction) const {
  const bool scattered =
      match.matched_pairs < kFewFactor * config_.min_pairs && match.residual_rms_m > kScatteredM;
  if (match.matched_pairs < config_.min_pairs || match.overlap < config_.min_overlap || scattered) {
    return false;
  }
  const Vector6d correction = twist_between(prediction.T_map_base, match.T_map_base);
  const auto beyond = [this](double size, double deviation, double limit) {
    return size > limit && size > config_.gate_sigmas * deviation;
  };
  return !beyond(correction.tail<3>().norm(), prediction.deviation.tail<3>().maxCoeff(),
                 config_.gate_translation_m) &&
         !beyond(correction.head<3>().norm(), prediction.deviation.head<3>().maxCoeff(),
                 config_.gate_rotation_deg * kRadPerDeg);
}

bool Registration::propagate(PoseEstimate& out) const {
  if (state_.history.empty() || !state_.motion.started()) {
    return false;
  }
  const Prior& now = state_.history.newest();
  const MethodTraits& traits = traits_for(now);
  const Prediction prediction = state_.motion.predict(now, traits);
  out = description_of(now, traits);
  out.mode = searching() ? PoseMode::kInitializing : PoseMode::kPriorOnly;
  out.T_map_base = prediction.T_map_base;
  out.T_map_odom = prediction.T_map_odom;
  if (lost()) {
    out.T_map_base = dead_reckoned(now);
    out.T_map_odom = out.T_map_base * now.T_odom_base.inverse();
    describe_lost(now, out);
    return true;
  }
  out.lost = state_.last.lost;
  out.lost_since_ns = state_.last.lost_since_ns;
  DeadReckoningError ahead = state_.unseen;
  ahead.move(now, step_to(now, prediction.T_map_base));
  out.covariance = state_.last.covariance + ahead.covariance() - state_.unseen.covariance();
  return true;
}

}  // namespace isobar
