// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the registration.
#pragma once

#include <cstddef>

namespace isobar {

/// Preparation, matching and solving of a scan, and the weight of the prior.
struct RegistrationConfig {
  /// False: no IMU, as PriorConfig::has_imu; no scan waits for gravity.
  bool has_imu = true;
  // Preparation of the scan.
  /// Returns nearer than this come from the robot itself [m] (from the sensor).
  double min_range_m = 0.5;
  /// Returns farther than this are not used [m]: their spacing and error are too large.
  double max_range_m = 80.0;
  /// Voxel of the points for the map, one point each: its edge [m]. Finer than about half a cell of the map
  /// costs time and gains nothing.
  double map_voxel_m = 0.125;
  /// Largest number of points in the ICP. More cost time and gain little.
  std::size_t sample_points = 1800;

  // Matching.
  /// Search distance of the first iteration [m]; the uncertainty of the prior is added.
  double first_distance_m = 0.8;
  /// Search distance of the last iteration [m]: at least the edge of a map cell.
  double last_distance_m = 0.35;
  /// Largest number of iterations.
  int max_iterations = 12;
  /// Convergence: a step with a translation below this [m] and a rotation below convergence_deg ends the ICP.
  double convergence_m = 0.0008;
  /// Convergence: largest rotation of the last step [deg].
  double convergence_deg = 0.01;
  /// Smallest scale of the robust loss [m]: the noise of the lidar and of the map.
  double min_residual_scale_m = 0.02;

  // Weight of the scan against the prior.
  /// Number of pairs with the information of one independent pair: neighbouring residuals are correlated, and
  /// counting every pair would make the covariance too small.
  double correlated_pairs = 15.0;
  /// Error of the map's normals [deg]. It imitates information in directions that no surface constrains (along a
  /// corridor), which is subtracted; a direction whose information may be noise alone is left to the prior.
  double normal_error_deg = 1.5;
  /// Error of height between a scan and the map when pressure fixes it [m].
  double height_error_m = 0.04;
  /// Error of a scan's roll and pitch against the scans that laid the map [deg]: far points count by it, not by the noise
  /// of the range.
  double attitude_error_deg = 0.4;

  // The prior of one step.
  /// Error of dead reckoning as share of the distance: slip and scale of wheels.
  double step_distance_error = 0.05;
  /// Smallest error of a step's translation [m].
  double step_translation_floor_m = 0.002;
  /// Smallest error of a step's rotation [deg]: that of a gyro on a shaking robot over a tenth of a second.
  double step_rotation_floor_deg = 0.05;
  /// Error of a step's rotation as share of the turn: an offset of 5 ms between the
  /// clocks of lidar and IMU is 5 % of a scan.
  double step_rotation_share = 0.05;
  /// Error of the mounts of lidar and IMU against each other [deg], 1 sigma, before any evidence.
  double mount_error_deg = 0.5;
  /// Error of roll and pitch from gravity in the adaptive method [deg], 1 sigma of one scan.
  double gravity_error_deg = 0.3;
  /// Without wheels: random acceleration [m/s^2].
  double free_acceleration_m_s2 = 3.0;
  /// Without wheels: time constant with which a velocity decays that no scan confirms [s].
  double velocity_memory_s = 2.0;
  /// Error of the predicted height in the methods with altitude in the prior [m]. Large, so that the ICP is
  /// free in z, as the paper's baselines are.
  double altitude_prior_error_m = 0.3;

  // Acceptance of a result.
  /// Least number of pairs.
  std::size_t min_pairs = 60;
  /// Least share of the sampled points with a correspondence.
  double min_overlap = 0.15;
  /// Gate of the correction, in standard deviations of the prior. A correction is refused where translation
  /// or rotation exceeds both this and its absolute gate below.
  double gate_sigmas = 8.0;
  /// Absolute gate of the translation [m].
  double gate_translation_m = 0.25;
  /// Absolute gate of the rotation [deg].
  double gate_rotation_deg = 4.0;
};

}  // namespace isobar
