// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {
namespace {

void add_preparation(RegistrationConfig& r, SectionBuilder& s) {
  s.number("min_range_m", &r.min_range_m, "m", 0.0, 5.0,
           "Shortest range used. 0.5: nearer returns come from the robot itself.");
  s.number("max_range_m", &r.max_range_m, "m", 5.0, 300.0,
           "Longest range used. 80: spacing and error of farther returns are too large.");
  s.number("map_voxel_m", &r.map_voxel_m, "m", 0.02, 0.5,
           "Voxel edge of the points kept for the map, one point each. 0.125: finer than half a map cell "
           "costs time and gains nothing.");
  s.number("sample_points", &r.sample_points, "", 200, 20'000,
           "Points that take part in the ICP. 1800: more cost time and gain little.");
}

void add_iteration(RegistrationConfig& r, SectionBuilder& s) {
  s.number("first_distance_m", &r.first_distance_m, "m", 0.2, 5.0,
           "Largest distance of a point to its plane's point in the first iteration; the prior's uncertainty "
           "is added. 0.8: about three map cells, for priors that are off.");
  s.number("last_distance_m", &r.last_distance_m, "m", 0.1, 2.0,
           "Largest distance of a point to its plane's point in the last iteration. 0.35: at least the edge "
           "of a map cell.");
  s.number("max_iterations", &r.max_iterations, "", 1, 50,
           "Largest number of iterations. 12 bounds the time of a scan that does not converge.");
  s.number(
      "convergence_m", &r.convergence_m, "m", 1e-5, 0.1,
      "Translation of a step below which, with convergence_deg, the iteration has converged. 0.0008: far "
      "below the noise of lidar and map (min_residual_scale_m).");
  s.number("convergence_deg", &r.convergence_deg, "deg", 1e-4, 1.0,
           "Rotation of a step below which, with convergence_m, the iteration has converged. 0.01 moves a "
           "point at 5 m by 0.9 mm.");
  s.number("min_residual_scale_m", &r.min_residual_scale_m, "m", 0.005, 0.5,
           "Smallest scale of the robust loss. 0.02: the noise of lidar and map.");
}

void add_information(RegistrationConfig& r, SectionBuilder& s) {
  s.number("correlated_pairs", &r.correlated_pairs, "", 1.0, 100.0,
           "Pairs that carry as much information as one independent pair. 15: neighbouring residuals are "
           "correlated, and counting each would make the covariance too small.");
  s.number("normal_error_deg", &r.normal_error_deg, "deg", 0.0, 10.0,
           "Error of the map's normals, 1 sigma. Along a corridor it imitates information, which is "
           "subtracted; a direction whose information may be such noise is left to the prior.");
  s.number("height_error_m", &r.height_error_m, "m", 0.0, 1.0,
           "Error of height between a scan and the map while pressure fixes it, 1 sigma. 0.04: slow local "
           "pressure noise (height.turbulence_sigma_m).");
  s.number("attitude_error_deg", &r.attitude_error_deg, "deg", 0.0, 10.0,
           "Error of roll and pitch while gravity fixes them, 1 sigma. 0.4: accelerometer bias is 0.18, "
           "motion adds to it.");
}

void add_step_prior(RegistrationConfig& r, SectionBuilder& s) {
  s.number("step_distance_error", &r.step_distance_error, "", 0.0, 1.0,
           "Error of dead reckoning as a share of the distance, 1 sigma: slip and scale of the wheels.");
  s.number("step_translation_floor_m", &r.step_translation_floor_m, "m", 1e-4, 1.0,
           "Lower bound of the error of a step's translation, 1 sigma. 0.002 keeps the prior of a standing "
           "robot from being exact.");
  s.number("step_rotation_floor_deg", &r.step_rotation_floor_deg, "deg", 1e-3, 10.0,
           "Lower bound of the error of a step's rotation, 1 sigma. 0.2: a gyro is better over a tenth of a "
           "second, but its filter corrects itself at times.");
  s.number("step_rotation_share", &r.step_rotation_share, "", 0.0, 1.0,
           "Error of a step's rotation as a share of the turn, 1 sigma. 0.05: clocks of lidar and IMU that "
           "differ by 5 ms are 5 % of a scan.");
  s.number("mount_error_deg", &r.mount_error_deg, "deg", 0.0, 10.0,
           "Error of roll and pitch between lidar and IMU before any evidence, 1 sigma. 0.5: as hands build "
           "robots.");
  s.number("gravity_error_deg", &r.gravity_error_deg, "deg", 1e-3, 90.0,
           "Error of roll and pitch from gravity in the adaptive method, 1 sigma. 0.1: accelerometer bias "
           "and motion.");
  s.number("free_acceleration_m_s2", &r.free_acceleration_m_s2, "m/s^2", 0.1, 20.0,
           "Random acceleration without wheels, 1 sigma. 3: a step at 10 Hz then errs by 1.5 cm.");
  s.number("velocity_memory_s", &r.velocity_memory_s, "s", 0.1, 100.0,
           "Decay time without wheels of a velocity that no scan confirms. 2: longer, a wrong velocity would "
           "carry the pose away.");
  s.number("altitude_prior_error_m", &r.altitude_prior_error_m, "m", 0.01, 10.0,
           "Error of the height prediction of 6dof-altitude and 4dof-altitude, 1 sigma. 0.3 leaves the ICP "
           "free in z, as the paper's baselines are.");
}

void add_acceptance(RegistrationConfig& r, SectionBuilder& s) {
  s.number("min_pairs", &r.min_pairs, "", 10, 1'000,
           "Fewest matched pairs of an accepted registration. 60: fewer leave the solution to chance.");
  s.number("min_overlap", &r.min_overlap, "", 0.0, 1.0,
           "Smallest share of the sampled points that is matched to the map. 0.15: doors and new rooms leave "
           "little overlap for a moment.");
  s.number("gate_sigmas", &r.gate_sigmas, "", 2.0, 100.0,
           "Largest correction in standard deviations of the prior; a larger one is refused if it also "
           "exceeds gate_translation_m or gate_rotation_deg. 8: the prior's covariance is itself an "
           "estimate.");
  s.number("gate_translation_m", &r.gate_translation_m, "m", 0.01, 5.0,
           "Translation that a correction must exceed to be refused by gate_sigmas. 0.25: smaller ones do no "
           "harm, whatever the prior says.");
  s.number("gate_rotation_deg", &r.gate_rotation_deg, "deg", 0.1, 90.0,
           "Rotation that a correction must exceed to be refused by gate_sigmas. 4: smaller ones do no harm, "
           "whatever the prior says.");
}

}  // namespace

void add_registration_settings(RegistrationConfig& registration, std::vector<Setting>& settings) {
  SectionBuilder s("registration", UsedBy::kRobot, settings);
  s.applies(Apply::kStage);
  add_preparation(registration, s);
  add_iteration(registration, s);
  add_information(registration, s);
  add_step_prior(registration, s);
  add_acceptance(registration, s);
}

}  // namespace isobar
