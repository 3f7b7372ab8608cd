// SPDX-License-Identifier: BSD-3-Clause
// All figures of one estimate against the reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/statistics/distribution.hpp"
#include "run/evaluation/association.hpp"
#include "run/evaluation/relative_error.hpp"
#include "run/evaluation/segments.hpp"
#include "run/evaluation/trajectory.hpp"

namespace isobar::evaluation {

struct EvaluationOptions {
  /// Longest hole [s], > 0. In the reference nothing is interpolated across a longer one; in the estimate it
  /// counts as not covered. Five scans at 10 Hz.
  double max_gap_s = 0.5;
  WindowOptions z_window{5.0, 0.1};      ///< of the paper's relative error on z
  WindowOptions pose_window{10.0, 0.1};  ///< of the relative pose error
  /// Of the absolute trajectory error. All other figures are taken from the start pose (Alignment::kStart).
  Alignment ate_alignment = Alignment::kStart;
  /// Flat segments whose mean heights differ by less belong to one floor [m], > 0: well below a storey.
  double floor_gap_m = 1.0;
  /// A run is lost if it covers less than this share of the time …
  double lost_below_coverage = 0.99;
  /// … or if its position is ever off by more than both of these: a drift this side of them is a poor
  /// estimate, beyond them the scans no longer meet the map.
  double lost_beyond_m = 5.0;
  double lost_beyond_share_of_distance = 0.05;
};

/// How far the estimate's height of a floor is off, over all flat segments on it.
struct FloorHeight {
  double reference_m = 0.0;    ///< mean height of the reference there
  double mean_error_m = 0.0;   ///< mean of estimate minus reference
  double worst_error_m = 0.0;  ///< mean error of the flat segment (visit) that is furthest off, signed
  std::size_t visits = 0;      ///< flat segments on this floor
};

/// Standard deviation of the estimated height, as the estimator itself gave it.
struct HeightSigma {
  std::int64_t stamp_ns = 0;
  double sigma_m = 0.0;
};

struct MethodFigures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double coverage = 0.0;           ///< share of the reference's time, 0 … 1
  std::size_t poses = 0;           ///< of the estimate
  std::size_t paired = 0;          ///< of them, with a reference
  StampRepairs repairs;            ///< what had to be repaired in the estimate's stamps
  double travelled_m = 0.0;        ///< by the reference
  bool whole_run_as_flat = false;  ///< no flat segment was named: z_rpe is taken over the whole run
  bool lost = false;

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
  double sigma_share =
      kNone;  ///< share of poses whose height error is at most twice their sigma; NaN: unknown
};

struct Evaluation {
  MethodFigures figures;
  std::vector<PosePair> pairs;  ///< estimates moved onto the reference at the start pose
  Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();  ///< that did it
  std::vector<double> z_rpe;                                               ///< each window's, [1]
};

/// Evaluates one estimate. `segments` may be empty; `sigmas` too. Throws DataError if the two trajectories
/// have no time in common.
Evaluation evaluate(const Trajectory& reference, const std::vector<Segment>& segments,
                    const Trajectory& estimate, const std::vector<HeightSigma>& sigmas,
                    const EvaluationOptions& options = {});

}  // namespace isobar::evaluation
