// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/registration.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar {

namespace {

// The first iterations only have to come near: a third of the points do that.
constexpr int kCoarseIterations = 2;
constexpr std::size_t kCoarseStride = 3;
// A coarse step smaller than this needs no second one.
constexpr double kSmallStepM = 0.02;
constexpr double kSmallStepRad = 0.3 * kRadPerDeg;
constexpr double kDistanceShrink = 0.5;
// Scans that wait for gravity before the map is started without it.
constexpr std::uint32_t kPatience = 30;
// Scans that start the map before it must be good for registration.
constexpr std::uint32_t kMostStartingScans = 20;

// Twist (omega, r) about the robot applied to a pose, axes of the map.
Eigen::Isometry3d apply(const Vector6d& twist, const Eigen::Isometry3d& T_map_base) {
  Eigen::Isometry3d moved = T_map_base;
  const double angle = twist.head<3>().norm();
  if (angle > 0.0) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, twist.head<3>() / angle));
    moved.linear() = (turn * Eigen::Quaterniond(T_map_base.linear())).normalized().toRotationMatrix();
  }
  moved.translation() += twist.tail<3>();
  return moved;
}

// Twist that leads from `from` to `to`; the inverse of apply().
Vector6d twist_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Vector6d twist;
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  twist << turn.angle() * turn.axis(), to.translation() - from.translation();
  return twist;
}

// From twist (omega, r) to the order x, y, z, roll, pitch, yaw. For small tilt the rotation vector's
// components are the errors of the angles.
Matrix6d as_pose_covariance(const Matrix6d& twist_covariance) {
  Matrix6d covariance;
  covariance << twist_covariance.bottomRightCorner<3, 3>(), twist_covariance.bottomLeftCorner<3, 3>(),
      twist_covariance.topRightCorner<3, 3>(), twist_covariance.topLeftCorner<3, 3>();
  return covariance;
}

Vector6d free_directions(const Basis& basis) { return basis.rowwise().norm(); }

}  // namespace

Registration::Registration(const RegistrationConfig& config, Method method,
                           const Eigen::Isometry3d& T_base_lidar)
    : config_(config),
      asked_(method),
      traits_(traits_of(method, HeightSource::kNone)),
      traits_with_height_(traits_of(method, HeightSource::kDifferential)),
      traits_without_imu_(traits_of(Method::k6Dof, HeightSource::kNone)),
      T_base_lidar_(T_base_lidar),
      motion_(config),
      deskewer_(T_base_lidar, config.min_range_m, config.max_range_m),
      sampler_(config.map_voxel_m, config.sample_points),
      correspondences_(config.sample_points) {
  last_.method = method;
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

void Registration::describe(const Prior& prior, const MethodTraits& traits, PoseEstimate& pose) const {
  pose = PoseEstimate{};
  pose.stamp_ns = prior.stamp_ns;
  pose.sequence = last_.sequence;
  pose.method = asked_;
  pose.effective_method = traits.method;
  pose.height_source = prior.height_source;
}

void Registration::prior_without_imu(std::int64_t stamp_ns, Prior& end) const {
  if (!history_.at(stamp_ns, end)) {
    end = stamp_ns < history_.oldest().stamp_ns ? history_.oldest() : history_.newest();
    end.stamp_ns = stamp_ns;
  }
  end.attitude_valid = false;
  end.velocity_valid = false;
  end.standing_still = false;
}

bool Registration::begin(const Scan& scan, Prior& end, PoseEstimate& pose) {
  if (history_.empty()) {
    pose = last_;
    pose.stamp_ns = scan.end_stamp_ns;
    return false;
  }
  if (!history_.dense_at(scan.end_stamp_ns) || !history_.at(scan.end_stamp_ns, end)) {
    prior_without_imu(scan.end_stamp_ns, end);
  }
  describe(end, traits_for(end), pose);
  pose.sequence = scan.sequence;
  if (!motion_.started()) {
    if (!end.attitude_valid && ++waited_ < kPatience) {
      return false;
    }
    motion_.start(end);
  }
  return true;
}

void Registration::register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out) {
  out.point_count = 0;
  Prior end;
  if (!begin(scan, end, out.pose)) {
    last_ = out.pose;
    return;
  }
  const MethodTraits& traits = traits_for(end);
  const Prediction prediction = motion_.predict(end, traits);
  prepare_scan(scan, history_, motion_.scan_motion(end, prediction), deskewer_, sampler_, out);

  PoseEstimate& pose = out.pose;
  pose.T_map_base = prediction.T_map_base;
  Matrix6d twist_covariance = prediction.deviation.cwiseAbs2().asDiagonal();
  bool good = false;
  if (traits.registers && !map.empty()) {
    good = solve(map, prediction, traits, end, pose, twist_covariance) && acceptable(pose, prediction);
  }
  // Until the map knows the place the scans go into it where the prior says. The first revolution may be cut.
  starting_ = starting_ && !good && traits.registers && started_scans_++ < kMostStartingScans;
  pose.mode = good ? PoseMode::kRegistered : (starting_ ? PoseMode::kInitializing : PoseMode::kPriorOnly);
  if (good) {
    motion_.correct(end, pose.T_map_base);
  } else {
    pose.T_map_base = prediction.T_map_base;
    twist_covariance = prediction.deviation.cwiseAbs2().asDiagonal();
    // Where the IMU is silent the way goes on from the last scan that knew its prior, once it is back.
    if (end.attitude_valid) motion_.keep_prediction(end, prediction);
  }
  finish(end, traits, twist_covariance, pose);
}

PairNoise Registration::pair_noise(const MethodTraits& traits, const Prior& prior) const {
  PairNoise noise;
  const Vector6d free = free_directions(traits.basis);
  const double attitude = config_.attitude_error_deg * kRadPerDeg;
  const double height2 =
      config_.height_error_m * config_.height_error_m + std::clamp(prior.height_variance_m2, 0.0, 1.0);
  Vector6d fixed;
  fixed << attitude * attitude, attitude * attitude, 0.0, 0.0, 0.0, height2;
  noise.fixed_variance = fixed.cwiseProduct(Vector6d::Ones() - free).cast<float>();
  noise.free = free.cast<float>();
  noise.noise_m = static_cast<float>(config_.min_residual_scale_m);
  return noise;
}

bool Registration::solve(const MapSnapshot& map, const Prediction& prediction, const MethodTraits& traits,
                         const Prior& prior, PoseEstimate& pose, Matrix6d& twist_covariance) {
  const PairNoise noise = pair_noise(traits, prior);
  const Eigen::Vector3d p_base_lidar = T_base_lidar_.translation();
  const std::span<const Eigen::Vector3f> sample = sampler_.sample();
  PriorTerm prior_term;
  prior_term.information = prediction.deviation.cwiseAbs2().cwiseInverse().asDiagonal();
  SolverWeights weights;
  weights.false_information = std::pow(std::sin(config_.normal_error_deg * kRadPerDeg), 2);
  weights.degenerate_information = config_.degenerate_information;
  const double search_m =
      2.0 * prediction.deviation.tail<3>().dot(traits.basis.bottomRows<3>().rowwise().norm());

  correspondences_.start(map, pose.T_map_base.translation());
  double distance_m = config_.first_distance_m + std::min(search_m, kLargestSearchM);
  int coarse = kCoarseIterations;
  Step step;
  for (int iteration = 0; iteration < config_.max_iterations; ++iteration) {
    const bool fine = coarse == 0;
    const std::span<const Pair> pairs = correspondences_.find(map, sample, fine ? 1 : kCoarseStride,
                                                              pose.T_map_base, p_base_lidar, distance_m);
    const float scale_m = residual_scale_m(pairs, noise, static_cast<float>(distance_m) / 2.0F);
    const NormalEquations equations = accumulate(pairs, noise, scale_m);
    weights.pair_information =
        1.0 / (config_.correlated_pairs * scale_m * scale_m * (fine ? 1.0 : 1.0 / kCoarseStride));
    prior_term.deviation = twist_between(prediction.T_map_base, pose.T_map_base);
    step = solve_step(equations, prior_term, traits.basis, weights);
    if (!step.solved) {
      return false;
    }
    pose.T_map_base = apply(step.twist, pose.T_map_base);
    pose.iterations = static_cast<std::uint32_t>(iteration + 1);
    pose.sampled_points = static_cast<std::uint32_t>(sample.size());
    pose.matched_pairs = static_cast<std::uint32_t>(fine ? pairs.size() : pairs.size() * kCoarseStride);
    pose.residual_rms_m =
        equations.weight_sum > 0.0 ? std::sqrt(equations.squared_error_sum / equations.weight_sum) : 0.0;
    const double moved_m = step.twist.tail<3>().norm();
    const double turned_rad = step.twist.head<3>().norm();
    if (fine && distance_m <= config_.last_distance_m && moved_m < config_.convergence_m &&
        turned_rad < config_.convergence_deg * kRadPerDeg) {
      break;
    }
    if (!fine) {
      coarse = moved_m < kSmallStepM && turned_rad < kSmallStepRad ? 0 : coarse - 1;
    }
    distance_m = coarse == 0 && moved_m < kSmallStepM
                     ? config_.last_distance_m
                     : std::max(config_.last_distance_m, distance_m * kDistanceShrink);
  }
  pose.overlap =
      sample.empty()
          ? 0.0
          : std::min(1.0, static_cast<double>(pose.matched_pairs) / static_cast<double>(sample.size()));
  pose.smallest_eigenvalues = step.smallest_eigenvalues;
  pose.degenerate = step.degenerate;
  const Vector6d fixed = Vector6d::Ones() - free_directions(traits.basis);
  twist_covariance = step.covariance;
  twist_covariance.diagonal() += fixed.cwiseProduct(prediction.deviation.cwiseAbs2());
  return true;
}

bool Registration::acceptable(const PoseEstimate& pose, const Prediction& prediction) const {
  if (pose.matched_pairs < config_.min_pairs || pose.overlap < config_.min_overlap) {
    return false;
  }
  const Vector6d correction = twist_between(prediction.T_map_base, pose.T_map_base);
  const auto beyond = [this](double size, double deviation, double limit) {
    return size > limit && size > config_.gate_sigmas * deviation;
  };
  return !beyond(correction.tail<3>().norm(), prediction.deviation.tail<3>().maxCoeff(),
                 config_.gate_translation_m) &&
         !beyond(correction.head<3>().norm(), prediction.deviation.head<3>().maxCoeff(),
                 config_.gate_rotation_deg * kRadPerDeg);
}

void Registration::finish(const Prior& prior, const MethodTraits& traits, const Matrix6d& twist_covariance,
                          PoseEstimate& pose) {
  pose.T_map_odom = pose.T_map_base * prior.T_odom_base.inverse();
  pose.covariance = as_pose_covariance(twist_covariance);
  if (traits.attitude_from_gravity) {
    pose.covariance(3, 3) = pose.covariance(4, 4) = std::max(prior.roll_pitch_variance_rad2, 1e-8);
  }
  if (traits.z_prediction == ZPrediction::kAltimeter && traits.attitude_from_gravity &&
      traits.basis.cols() == 3) {
    pose.covariance(2, 2) = std::max(prior.height_variance_m2, 1e-8);
  }
  last_ = pose;
}

bool Registration::propagate(PoseEstimate& out) const {
  if (history_.empty() || !motion_.started()) {
    return false;
  }
  const Prior& now = history_.newest();
  const MethodTraits& traits = traits_for(now);
  describe(now, traits, out);
  out.mode = PoseMode::kPriorOnly;
  const Prediction prediction = motion_.predict(now, traits);
  out.T_map_base = prediction.T_map_base;
  out.T_map_odom = prediction.T_map_odom;
  Matrix6d step = prediction.deviation.cwiseAbs2().asDiagonal();
  out.covariance = last_.covariance + as_pose_covariance(step);
  if (traits.attitude_from_gravity) {
    out.covariance(3, 3) = out.covariance(4, 4) = std::max(now.roll_pitch_variance_rad2, 1e-8);
  }
  if (traits.z_prediction == ZPrediction::kAltimeter) {
    out.covariance(2, 2) = std::max(now.height_variance_m2, 1e-8);
  }
  return true;
}

}  // namespace isobar
