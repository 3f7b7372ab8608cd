// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "core/stamp.hpp"
#include "run/evaluation/floors.hpp"

namespace isobar::evaluation {

namespace {

double height_error_m(const PosePair& pair) {
  return pair.estimate.position_m.z() - pair.reference.position_m.z();
}

double position_error_m(const PosePair& pair) {
  return (pair.estimate.position_m - pair.reference.position_m).norm();
}

void add_relative_figures(Evaluation& evaluation, const std::vector<Segment>& flat,
                          const EvaluationOptions& options) {
  MethodFigures& figures = evaluation.figures;
  figures.whole_run_as_flat = flat.empty();
  const std::vector<PosePair>& pairs = evaluation.pairs;
  evaluation.z_rpe =
      relative_z_error(pairs, make_windows(pairs, flat.empty() ? nullptr : &flat, options.z_window));
  figures.z_rpe = summarize(evaluation.z_rpe);
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const RelativePoseError& error :
       relative_pose_error(pairs, make_windows(pairs, nullptr, options.pose_window))) {
    translations.push_back(error.translation);
    rotations.push_back(error.rotation_rad_m);
  }
  figures.rpe_translation = summarize(std::move(translations));
  figures.rpe_rotation_rad_m = summarize(std::move(rotations));
}

void add_height_figures(Evaluation& evaluation, const std::vector<Segment>& flat,
                        const EvaluationOptions& options) {
  MethodFigures& figures = evaluation.figures;
  figures.final_height_error_m = height_error_m(evaluation.pairs.back());
  figures.largest_height_error_m = 0.0;
  for (const PosePair& pair : evaluation.pairs) {
    const double error_m = height_error_m(pair);
    if (std::abs(error_m) > std::abs(figures.largest_height_error_m))
      figures.largest_height_error_m = error_m;
  }
  figures.floors = floor_heights(evaluation.pairs, flat, options.floor_gap_m);
}

void add_settled_floors(Evaluation& evaluation, std::vector<Segment> flat, const EvaluationOptions& options) {
  const std::int64_t from_ns = evaluation.pairs.front().stamp_ns + std::llround(1e9 * options.settling_s);
  for (Segment& segment : flat) segment.start_ns = std::max(segment.start_ns, from_ns);
  std::erase_if(flat, [](const Segment& segment) { return segment.start_ns >= segment.end_ns; });
  const std::vector<FloorHeight> floors = floor_heights(evaluation.pairs, flat, options.floor_gap_m);
  if (floors.empty()) return;
  MethodFigures& figures = evaluation.figures;
  figures.settled_floors_mean_m = 0.0;
  figures.settled_floors_worst_m = 0.0;
  for (const FloorHeight& floor : floors) {
    const double error_m = std::abs(floor.mean_error_m);
    figures.settled_floors_mean_m += error_m / static_cast<double>(floors.size());
    figures.settled_floors_worst_m = std::max(figures.settled_floors_worst_m, error_m);
  }
}

void add_absolute_figures(Evaluation& evaluation, const EvaluationOptions& options) {
  MethodFigures& figures = evaluation.figures;
  std::vector<PosePair> aligned = evaluation.pairs;
  if (options.ate_alignment != Alignment::kStart) {
    apply_transform(aligned, alignment_transform(aligned, options.ate_alignment));
  }
  double sum_m2 = 0.0;
  figures.ate_max_m = 0.0;
  for (const PosePair& pair : aligned) {
    const double error_m = position_error_m(pair);
    sum_m2 += error_m * error_m;
    figures.ate_max_m = std::max(figures.ate_max_m, error_m);
  }
  figures.ate_rms_m = std::sqrt(sum_m2 / static_cast<double>(aligned.size()));
  // Rotation about z closest to the remaining one at the last pose, as in the alignment at the start.
  const PosePair& last = evaluation.pairs.back();
  const Eigen::Quaterniond left = last.estimate.attitude * last.reference.attitude.conjugate();
  figures.yaw_drift_rad = wrap_angle_rad(2.0 * std::atan2(left.z(), left.w()));
  if (figures.travelled_m > 0.0) {
    figures.ate_share = figures.ate_rms_m / figures.travelled_m;
    figures.yaw_drift_rad_m = std::abs(figures.yaw_drift_rad) / figures.travelled_m;
  }
}

/// Poses without a sigma of exactly their stamp are left out.
double share_within_two_sigma(const std::vector<PosePair>& pairs, std::vector<HeightSigma> sigmas) {
  std::sort(sigmas.begin(), sigmas.end(),
            [](const HeightSigma& a, const HeightSigma& b) { return a.stamp_ns < b.stamp_ns; });
  std::size_t known = 0;
  std::size_t within = 0;
  auto sigma = sigmas.begin();
  for (const PosePair& pair : pairs) {
    while (sigma != sigmas.end() && sigma->stamp_ns < pair.estimate.stamp_ns) ++sigma;
    if (sigma == sigmas.end()) break;
    if (sigma->stamp_ns != pair.estimate.stamp_ns || !std::isfinite(sigma->sigma_m)) continue;
    ++known;
    if (std::abs(height_error_m(pair)) <= 2.0 * sigma->sigma_m) ++within;
  }
  return known == 0 ? MethodFigures::kNone : static_cast<double>(within) / static_cast<double>(known);
}

/// Poses of the estimate that have no reference.
std::size_t poses_outside(const Trajectory& reference, const Trajectory& estimate,
                          const std::vector<PosePair>& pairs) {
  if (!reference_is_sparser(reference, estimate)) return estimate.poses.size() - pairs.size();
  const std::int64_t begin_ns = reference.poses.front().stamp_ns;
  const std::int64_t end_ns = reference.poses.back().stamp_ns;
  return static_cast<std::size_t>(std::count_if(
      estimate.poses.begin(), estimate.poses.end(),
      [&](const StampedPose& pose) { return pose.stamp_ns < begin_ns || pose.stamp_ns > end_ns; }));
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", seconds);
  return text;
}

/// Why two trajectories have no pose at the same time.
DataError no_pair(const Trajectory& reference, const Trajectory& estimate, std::optional<double> max_gap_s) {
  const double late_s = seconds_between(reference.poses.back().stamp_ns, estimate.poses.front().stamp_ns);
  const double early_s = seconds_between(estimate.poses.back().stamp_ns, reference.poses.front().stamp_ns);
  if (late_s > 0.0) return DataError("begins " + seconds_text(late_s) + " after the end of the reference");
  if (early_s > 0.0) return DataError("ends " + seconds_text(early_s) + " before the start of the reference");
  const bool interpolates_estimate = reference_is_sparser(reference, estimate);
  const Trajectory& between = interpolates_estimate ? estimate : reference;
  return DataError(std::string(interpolates_estimate ? "it" : "the reference") + " has one pose in " +
                   seconds_text(typical_interval_s(between)) + ", further apart than the longest gap of " +
                   seconds_text(bridged_gap_s(between, max_gap_s)));
}

/// Angles between the estimate and a reference that has none mean nothing.
void forget_angles(MethodFigures& figures) {
  figures.rpe_translation = {};
  figures.rpe_rotation_rad_m = {};
  figures.yaw_drift_rad = MethodFigures::kNone;
  figures.yaw_drift_rad_m = MethodFigures::kNone;
  figures.consistency = {};
}

}  // namespace

Evaluation evaluate(const Trajectory& reference, const std::vector<Segment>& segments,
                    const Trajectory& estimate, const std::vector<HeightSigma>& sigmas,
                    const EvaluationOptions& options, std::vector<PoseCovariance> covariances) {
  Evaluation evaluation;
  evaluation.pairs = associate(reference, estimate, options.max_gap_s);
  if (evaluation.pairs.empty()) throw no_pair(reference, estimate, options.max_gap_s);
  const bool has_attitude = !lacks_attitude(evaluation.pairs);
  evaluation.T_reference_estimate =
      alignment_transform(evaluation.pairs, has_attitude ? Alignment::kStart : Alignment::kStartOfPath);
  apply_transform(evaluation.pairs, evaluation.T_reference_estimate);

  MethodFigures& figures = evaluation.figures;
  figures.coverage = coverage(reference, estimate, options.max_gap_s);
  figures.poses = estimate.poses.size();
  figures.paired = evaluation.pairs.size();
  figures.outside = poses_outside(reference, estimate, evaluation.pairs);
  figures.repairs = estimate.repairs;
  figures.travelled_m = travelled_distance_m(reference.poses).back();
  const std::vector<Segment> flat = flat_segments(segments);
  add_relative_figures(evaluation, flat, options);
  add_height_figures(evaluation, flat, options);
  add_settled_floors(evaluation, flat, options);
  add_absolute_figures(evaluation, options);
  figures.consistency =
      consistency_of(evaluation.pairs, std::move(covariances), evaluation.T_reference_estimate);
  figures.sigma_share = share_within_two_sigma(evaluation.pairs, sigmas);
  figures.reference_attitude = has_attitude;
  if (!has_attitude) forget_angles(figures);
  figures.verdict =
      verdict_on(evaluation.pairs, reference, figures.coverage, figures.travelled_m, options.verdict);
  return evaluation;
}

}  // namespace isobar::evaluation
