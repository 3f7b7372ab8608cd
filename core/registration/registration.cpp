// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/registration.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/registration/twist.hpp"

namespace isobar {

namespace {

// Number of scans for which the start of the map waits for a valid attitude (gravity); then it starts
// without.
constexpr std::uint32_t kMaxScansWithoutGravity = 30;
// Bootstrap scans before registration must succeed: they enter the map at the predicted pose.
constexpr std::uint32_t kMaxBootstrapScans = 20;
// Floor of reported variances [m^2, rad^2]: 0.1 mm, 0.1 mrad.
constexpr double kLeastVariance = 1e-8;

Matrix6d covariance_of(const Prediction& prediction) { return prediction.deviation.cwiseAbs2().asDiagonal(); }

void copy_statistics(const MatchResult& match, PoseEstimate& pose) {
  pose.iterations = match.iterations;
  pose.sampled_points = match.sampled_points;
  pose.matched_pairs = match.matched_pairs;
  pose.residual_rms_m = match.residual_rms_m;
  pose.overlap = match.overlap;
  pose.degenerate = match.degenerate;
  pose.smallest_eigenvalues = match.smallest_eigenvalues;
}

// Roll and pitch fixed by gravity and z fixed by the altimeter have the prior's variances.
void set_fixed_variances(const Prior& prior, bool gravity_fixes_tilt, bool altimeter_fixes_z,
                         Matrix6d& covariance) {
  if (gravity_fixes_tilt) {
    covariance(3, 3) = covariance(4, 4) = std::max(prior.roll_pitch_variance_rad2, kLeastVariance);
  }
  if (altimeter_fixes_z) {
    covariance(2, 2) = std::max(prior.height_variance_m2, kLeastVariance);
  }
}

}  // namespace

Registration::Registration(const RegistrationConfig& config, Method method,
                           const Eigen::Isometry3d& T_base_lidar)
    : config_(config),
      asked_(method),
      traits_(traits_of(method, HeightSource::kNone)),
      traits_with_height_(traits_of(method, HeightSource::kDifferential)),
      traits_without_imu_(traits_of(Method::k6Dof, HeightSource::kNone)),
      motion_(config),
      deskewer_(T_base_lidar, config.min_range_m, config.max_range_m),
      sampler_(config.map_voxel_m, config.sample_points),
      matcher_(config, T_base_lidar.translation()) {
  last_.method = method;
}

void Registration::take_over(const Registration& other) {
  history_ = other.history_;  // rings of one length
  motion_.take_over(other.motion_);
  last_ = other.last_;
  scans_without_gravity_ = other.scans_without_gravity_;
  bootstrap_scans_ = other.bootstrap_scans_;
  bootstrapping_ = other.bootstrapping_;
}

void Registration::add_prior(const Prior& prior) { history_.add(prior); }

bool Registration::ready(const Scan& scan) const {
  return !history_.empty() && history_.newest().stamp_ns >= scan.end_stamp_ns;
}

const MethodTraits& Registration::traits_for(const Prior& prior) const {
  if (!prior.attitude_valid && traits_.registers && motion_.started()) {
    return traits_without_imu_;
  }
  return prior.height_source == HeightSource::kNone ? traits_ : traits_with_height_;
}

PoseEstimate Registration::description_of(const Prior& prior, const MethodTraits& traits) const {
  PoseEstimate pose;
  pose.stamp_ns = prior.stamp_ns;
  pose.sequence = last_.sequence;
  pose.method = asked_;
  pose.effective_method = traits.method;
  pose.height_source = prior.height_source;
  return pose;
}

Prior Registration::prior_at(std::int64_t stamp_ns) const {
  Prior prior;
  const bool known = history_.dense_at(stamp_ns) && history_.at(stamp_ns, prior);
  return known ? prior : prior_without_imu(stamp_ns);
}

Prior Registration::prior_without_imu(std::int64_t stamp_ns) const {
  Prior prior;
  if (!history_.at(stamp_ns, prior)) {
    prior = stamp_ns < history_.oldest().stamp_ns ? history_.oldest() : history_.newest();
    prior.stamp_ns = stamp_ns;
  }
  prior.attitude_valid = false;
  prior.velocity_valid = false;
  prior.standing_still = false;
  return prior;
}

// False while the map waits for gravity.
bool Registration::start_motion(const Prior& prior) {
  if (motion_.started()) return true;
  if (!prior.attitude_valid && ++scans_without_gravity_ < kMaxScansWithoutGravity) return false;
  motion_.start(prior);
  return true;
}

void Registration::register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out) {
  PoseEstimate& pose = out.pose;
  out.point_count = 0;
  if (history_.empty()) {
    last_.stamp_ns = scan.end_stamp_ns;
    pose = last_;
    return;
  }
  const Prior end = prior_at(scan.end_stamp_ns);
  pose = description_of(end, traits_for(end));
  pose.sequence = scan.sequence;
  if (!start_motion(end)) {
    last_ = pose;
    return;
  }
  const MethodTraits& traits = traits_for(end);
  const Prediction prediction = motion_.predict(end, traits);
  prepare_scan(scan, history_, motion_.scan_motion(end, prediction), deskewer_, sampler_, out);

  const MatchResult result = map.empty() ? MatchResult{} : match(map, end, prediction, traits);
  const bool registered = result.solved && acceptable(result, prediction);
  copy_statistics(result, pose);
  pose.mode = mode_after(registered, traits);
  pose.T_map_base = registered ? result.T_map_base : prediction.T_map_base;
  pose.T_map_odom = pose.T_map_base * end.T_odom_base.inverse();
  pose.covariance = as_pose_covariance(registered ? result.twist_covariance : covariance_of(prediction));
  const bool altimeter_fixes_z = traits.z_prediction == ZPrediction::kAltimeter &&
                                 traits.attitude_from_gravity && traits.basis.cols() == 3;
  set_fixed_variances(end, traits.attitude_from_gravity, altimeter_fixes_z, pose.covariance);

  // A scan with neither IMU nor registration does not become the start of the next prediction: the scan
  // before it stays the start.
  if (registered) {
    motion_.correct(end, pose.T_map_base);
  } else if (end.attitude_valid) {
    motion_.keep_prediction(end, prediction);
  }
  last_ = pose;
}

MatchResult Registration::match(const MapSnapshot& map, const Prior& prior, const Prediction& prediction,
                                const MethodTraits& traits) {
  if (!traits.registers) return {};
  return matcher_.match({.map = map,
                         .p_base = sampler_.sample(),
                         .traits = traits,
                         .prediction = prediction,
                         .height_variance_m2 = prior.height_variance_m2});
}

PoseMode Registration::mode_after(bool registered, const MethodTraits& traits) {
  // Bootstrap: until the first success scans enter the map at the predicted pose. The first revolution may be
  // incomplete, and one scan may cover too little of the place.
  bootstrapping_ =
      bootstrapping_ && !registered && traits.registers && bootstrap_scans_++ < kMaxBootstrapScans;
  if (registered) return PoseMode::kRegistered;
  return bootstrapping_ ? PoseMode::kInitializing : PoseMode::kPriorOnly;
}

bool Registration::acceptable(const MatchResult& match, const Prediction& prediction) const {
  if (match.matched_pairs < config_.min_pairs || match.overlap < config_.min_overlap) {
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
  if (history_.empty() || !motion_.started()) {
    return false;
  }
  const Prior& now = history_.newest();
  const MethodTraits& traits = traits_for(now);
  const Prediction prediction = motion_.predict(now, traits);
  out = description_of(now, traits);
  out.mode = PoseMode::kPriorOnly;
  out.T_map_base = prediction.T_map_base;
  out.T_map_odom = prediction.T_map_odom;
  out.covariance = last_.covariance + as_pose_covariance(covariance_of(prediction));
  set_fixed_variances(now, traits.attitude_from_gravity, traits.z_prediction == ZPrediction::kAltimeter,
                      out.covariance);
  return true;
}

}  // namespace isobar
