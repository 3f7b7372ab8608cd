// SPDX-License-Identifier: BSD-3-Clause
// Figures of one estimate against the reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/statistics/distribution.hpp"
#include "run/evaluation/association.hpp"
#include "run/evaluation/consistency.hpp"
#include "run/evaluation/relative_error.hpp"
#include "run/evaluation/segments.hpp"
#include "run/evaluation/surface_index.hpp"
#include "run/evaluation/trajectory.hpp"
#include "run/evaluation/verdict.hpp"

namespace isobar::evaluation {

/// Parameters of the evaluation.
struct EvaluationOptions {
  /// Longest gap [s], > 0: across a longer one nothing is interpolated and the estimate does not cover the time;
  /// not given: bridged_gap_s().
  std::optional<double> max_gap_s;
  WindowOptions z_window{5.0, 0.1};      ///< of the paper's relative error on z
  WindowOptions pose_window{10.0, 0.1};  ///< of the relative pose error
  /// Alignment for the absolute trajectory error. All other figures use Alignment::kStart.
  Alignment ate_alignment = Alignment::kStart;
  /// Largest difference of mean heights of flat segments on one floor [m], > 0: well below a storey.
  double floor_gap_m = 1.0;
  /// Time at the start that MethodFigures::settled_floors_mean_m leaves out [s].
  double settling_s = 60.0;
  VerdictLimits verdict;
};

/// Height error of the estimate on one floor, over all flat segments there.
struct FloorHeight {
  double reference_m = 0.0;    ///< mean height of the reference there
  double mean_error_m = 0.0;   ///< mean of estimate minus reference
  double worst_error_m = 0.0;  ///< largest mean error of a flat segment (visit), signed
  std::size_t visits = 0;      ///< flat segments on this floor
};

/// Standard deviation of the estimated height, reported by the estimator.
struct HeightSigma {
  std::int64_t stamp_ns = 0;
  double sigma_m = 0.0;
};

/// Figures of one method; NaN: unknown.
struct MethodFigures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double coverage = 0.0;           ///< share of the reference's time, 0 … 1
  std::size_t poses = 0;           ///< of the estimate
  std::size_t paired = 0;          ///< common times of estimate and reference
  std::size_t outside = 0;         ///< poses of the estimate outside the reference's time or in its gaps
  StampRepairs repairs;            ///< of the estimate's stamps
  double travelled_m = 0.0;        ///< by the reference
  bool whole_run_as_flat = false;  ///< no flat segments: z_rpe is over the whole run
  bool reference_attitude =
      true;  ///< false: the reference has positions only, and figures of angles are unknown
  Verdict verdict;

  Distribution z_rpe;                     ///< relative error on z, 0 … [1]
  Distribution rpe_translation;           ///< [1]
  Distribution rpe_rotation_rad_m;        ///< per metre of travel
  double final_height_error_m = kNone;    ///< signed, estimate minus reference
  double largest_height_error_m = kNone;  ///< signed, of the largest magnitude
  std::vector<FloorHeight> floors;        ///< lowest first; empty without flat segments
  double ate_rms_m = kNone;               ///< root mean square of the distance between estimate and reference
  double ate_max_m = kNone;
  double ate_share = kNone;        ///< ate_rms_m / travelled_m [1]
  double yaw_drift_rad = kNone;    ///< at the last pose, signed
  double yaw_drift_rad_m = kNone;  ///< |yaw_drift_rad| / travelled_m
  /// Magnitudes of the floors' mean height errors without the first minute: mean and largest.
  double settled_floors_mean_m = kNone;
  double settled_floors_worst_m = kNone;
  ConsistencyFigures consistency;
  MapFigures map;              ///< set by evaluate_methods()
  double sigma_share = kNone;  ///< share of poses with a height error of at most two sigma, 0 … 1
};

/// Figures, and what they are computed from.
struct Evaluation {
  MethodFigures figures;
  std::vector<PosePair> pairs;  ///< estimates aligned at the start pose
  Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();  ///< of that alignment
  std::vector<double> z_rpe;                                               ///< of each window [1]
};

/// Evaluates one estimate. `segments`, `sigmas` and `covariances` may be empty.
/// @throws DataError when the two trajectories have no time in common
Evaluation evaluate(const Trajectory& reference, const std::vector<Segment>& segments,
                    const Trajectory& estimate, const std::vector<HeightSigma>& sigmas,
                    const EvaluationOptions& options = {}, std::vector<PoseCovariance> covariances = {});

}  // namespace isobar::evaluation
