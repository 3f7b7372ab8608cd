// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the registration.
#pragma once

#include <cstddef>

namespace isobar {

/// How a scan is prepared, matched and solved, and how much the prior weighs.
struct RegistrationConfig {
  // Preparation of the scan.
  /// Returns nearer than this come from the robot itself [m], 0 … 5 (from the sensor).
  double min_range_m = 0.5;
  /// Returns farther than this are not used [m], 5 … 300: their spacing and error are too large.
  double max_range_m = 80.0;
  /// Points kept for the map: at most one a voxel of this edge [m], 0.02 … 0.5. Finer than about half a cell
  /// of the map costs time and gains nothing.
  double map_voxel_m = 0.125;
  /// Points that take part in the ICP, 200 … 20000. More cost time and gain little.
  std::size_t sample_points = 1800;

  // Matching.
  /// Largest distance to the map of the first iteration [m], 0.2 … 5. Uncertainty of the prior is added.
  double first_distance_m = 0.8;
  /// Largest distance to the map of the last iteration [m], 0.1 … 2. At least the edge of a map cell.
  double last_distance_m = 0.35;
  /// Iterations at most, 1 … 50.
  int max_iterations = 12;
  /// Iteration stops when the step is below this [m] …, 1e-5 … 0.1.
  double convergence_m = 0.0008;
  /// … and below this [deg], 1e-4 … 1.
  double convergence_deg = 0.01;
  /// Smallest scale of the robust loss [m], 0.005 … 0.5: the noise of the lidar and of the map.
  double min_residual_scale_m = 0.02;

  // Weight of what the scan says against the prior.
  /// Pairs that carry as much information as one independent pair, 1 … 100: neighbouring residuals are
  /// correlated, so that counting every pair makes the covariance dishonest.
  double correlated_pairs = 15.0;
  /// Error of the map's normals [deg], 0 … 10. It fakes information in directions that no surface constrains
  /// (along a corridor); this much is taken away.
  double normal_error_deg = 1.5;
  /// A direction with less information a pair than this is degenerate, 0 … 0.3. 1/3 is a scan that
  /// constrains all directions alike; 0.01 means that one pair in a hundred faces that direction.
  double degenerate_information = 0.01;
  /// Error of height between a scan and the map when pressure fixes it [m], 0 … 1.
  double height_error_m = 0.04;
  /// Error of roll and pitch when gravity fixes them [deg], 0 … 10.
  double attitude_error_deg = 0.4;

  // The prior of one step.
  /// Error of dead reckoning as share of the distance, 0 … 1: slip and scale of wheels.
  double step_distance_error = 0.05;
  /// Smallest error of a step's translation [m], 1e-4 … 1.
  double step_translation_floor_m = 0.002;
  /// Smallest error of a step's rotation [deg], 1e-3 … 10. A gyro is better than this for a tenth of a
  /// second; its filter, which corrects itself at times, is not.
  double step_rotation_floor_deg = 0.2;
  /// Error of a step's rotation as share of the turn, 0 … 1: clocks of lidar and IMU that differ by 5 ms are
  /// 5 % of a scan.
  double step_rotation_share = 0.05;
  /// Without wheels: how much the velocity changes at random [m/s^2], 0.1 … 20.
  double free_acceleration_m_s2 = 3.0;
  /// Without wheels: time in which a velocity not confirmed by scans dies away [s], 0.1 … 100.
  double velocity_memory_s = 2.0;
  /// Error of the height prediction of "altitude in the prior" methods [m], 0.01 … 10. Wide, so that the ICP
  /// is free in z, as the paper's baselines are.
  double altitude_prior_error_m = 0.3;

  // What makes a result bad.
  /// Pairs needed, 10 … 1000.
  std::size_t min_pairs = 60;
  /// Share of the sampled points that must find the map, 0 … 1.
  double min_overlap = 0.15;
  /// A correction of more than this many standard deviations of the prior is refused, 2 … 100 …
  double gate_sigmas = 8.0;
  /// … if it is also more than this [m], 0.01 … 5.
  double gate_translation_m = 0.25;
  /// … or more than this [deg], 0.1 … 90.
  double gate_rotation_deg = 4.0;
};

}  // namespace isobar
