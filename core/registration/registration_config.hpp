// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the registration.
#pragma once

#include <cstddef>

namespace isobar {

/// How a scan is prepared, matched and solved, and how much the prior weighs.
struct RegistrationConfig {
  // Preparation of the scan.
  /// Returns nearer than this come from the robot itself [m] (from the sensor).
  double min_range_m = 0.5;
  /// Returns farther than this are not used [m]: their spacing and error are too large.
  double max_range_m = 80.0;
  /// Points kept for the map: at most one a voxel of this edge [m]. Finer than about half a cell
  /// of the map costs time and gains nothing.
  double map_voxel_m = 0.125;
  /// Points that take part in the ICP. More cost time and gain little.
  std::size_t sample_points = 1800;

  // Matching.
  /// Largest distance to the map of the first iteration [m]. Uncertainty of the prior is added.
  double first_distance_m = 0.8;
  /// Largest distance to the map of the last iteration [m]. At least the edge of a map cell.
  double last_distance_m = 0.35;
  /// Iterations at most.
  int max_iterations = 12;
  /// Iteration stops when the step is below this [m] …
  double convergence_m = 0.0008;
  /// … and below this [deg].
  double convergence_deg = 0.01;
  /// Smallest scale of the robust loss [m]: the noise of the lidar and of the map.
  double min_residual_scale_m = 0.02;

  // Weight of what the scan says against the prior.
  /// Pairs that carry as much information as one independent pair: neighbouring residuals are
  /// correlated, so that counting every pair makes the covariance dishonest.
  double correlated_pairs = 15.0;
  /// Error of the map's normals [deg]. It fakes information in directions that no surface constrains
  /// (along a corridor); this much is taken away.
  double normal_error_deg = 1.5;
  /// A direction with less information a pair than this is degenerate. 1/3 is a scan that
  /// constrains all directions alike; 0.01 means that one pair in a hundred faces that direction.
  double degenerate_information = 0.01;
  /// Error of height between a scan and the map when pressure fixes it [m].
  double height_error_m = 0.04;
  /// Error of roll and pitch when gravity fixes them [deg].
  double attitude_error_deg = 0.4;

  // The prior of one step.
  /// Error of dead reckoning as share of the distance: slip and scale of wheels.
  double step_distance_error = 0.05;
  /// Smallest error of a step's translation [m].
  double step_translation_floor_m = 0.002;
  /// Smallest error of a step's rotation [deg]. A gyro is better than this for a tenth of a
  /// second; its filter, which corrects itself at times, is not.
  double step_rotation_floor_deg = 0.2;
  /// Error of a step's rotation as share of the turn: clocks of lidar and IMU that differ by 5 ms are
  /// 5 % of a scan.
  double step_rotation_share = 0.05;
  /// Without wheels: how much the velocity changes at random [m/s^2].
  double free_acceleration_m_s2 = 3.0;
  /// Without wheels: time in which a velocity not confirmed by scans dies away [s].
  double velocity_memory_s = 2.0;
  /// Error of the height prediction of "altitude in the prior" methods [m]. Wide, so that the ICP
  /// is free in z, as the paper's baselines are.
  double altitude_prior_error_m = 0.3;

  // What makes a result bad.
  /// Pairs needed.
  std::size_t min_pairs = 60;
  /// Share of the sampled points that must find the map.
  double min_overlap = 0.15;
  /// A correction of more than this many standard deviations of the prior is refused …
  double gate_sigmas = 8.0;
  /// … if it is also more than this [m].
  double gate_translation_m = 0.25;
  /// … or more than this [deg].
  double gate_rotation_deg = 4.0;
};

}  // namespace isobar
