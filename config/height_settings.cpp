// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {
namespace {

void add_acceleration(HeightConfig& height, SectionBuilder& s) {
  s.number("accel_bias_sigma_m_s2", &height.accel_bias_sigma_m_s2, "m/s^2", 0.0, 1.0,
           "Bias of the vertical acceleration, 1 sigma: accelerometer, local gravity (9.780 to 9.832) and "
           "tilt together.");
  s.number("accel_bias_walk_m_s2_sqrt_s", &height.accel_bias_walk_m_s2_sqrt_s, "m/s^2/sqrt(s)", 0.0, 0.1,
           "Random walk of the vertical acceleration's bias. 0.0003 is 0.018 m/s^2 in an hour, more than the "
           "accelerometer's alone: tilt errors change.");
  s.number("accel_noise_m_s_sqrt_s", &height.accel_noise_m_s_sqrt_s, "m/s/sqrt(s)", 1e-5, 1.0,
           "Lower bound of the vertical acceleration's noise, which vibration raises online. 0.003 is 0.3 "
           "mg/sqrt(Hz).");
}

void add_climb(HeightConfig& height, SectionBuilder& s) {
  s.number("slope_sigma_rad", &height.slope_sigma_rad, "rad", 0.0, 0.2,
           "Constant angle between the wheels' rolling direction and the x-y plane of base_link as the "
           "attitude has it, 1 sigma. 0.004 is 0.23 deg: 0.1 of mounting, 2 to 4 mg of accelerometer bias.");
  s.number("slope_walk_rad_sqrt_s", &height.slope_walk_rad_sqrt_s, "rad/sqrt(s)", 0.0, 0.1,
           "Random walk of the angle slope_sigma_rad. 0.00002 is 0.0012 rad in an hour.");
  s.number("slope_error_rad", &height.slope_error_rad, "rad", 0.0, 0.2,
           "Varying error of the slope, 1 sigma: attitude, suspension, uneven floor. 0.002 is 0.11 deg.");
  s.number("slope_error_correlation_s", &height.slope_error_correlation_s, "s", 0.1, 60.0,
           "Correlation time of the varying slope error. 3: an uneven floor lasts a few metres.");
  s.number("slip_share", &height.slip_share, "", 0.0, 1.0,
           "Error of the climb speed as a share of it, 1 sigma. 0.1: wheels and tracks slip on stairs.");
  s.number("slip_correlation_s", &height.slip_correlation_s, "s", 0.1, 60.0,
           "Correlation time of the slip on a climb. 3: slip lasts a few steps of a staircase.");
  s.number("rest_speed_m_s_sqrt_s", &height.rest_speed_m_s_sqrt_s, "m/s/sqrt(Hz)", 1e-6, 1.0,
           "Vertical speed of the ground below a standing robot, as white noise. 0.0003: 2 mm in a minute; "
           "an elevator is detected separately (moving_ground_speed_m_s).");
}

void add_air(HeightConfig& height, SectionBuilder& s) {
  s.number(
      "turbulence_sigma_m", &height.turbulence_sigma_m, "m", 0.0, 10.0,
      "Slow local pressure noise as a height, rms: turbulence, ventilation, doors. 0.04 is 0.5 Pa, twice "
      "the difference of two good barometers in still air.");
  s.number("turbulence_time_s", &height.turbulence_time_s, "s", 0.1, 600.0,
           "Correlation time of the slow local pressure noise. 10: gusts and doors come and go.");
  s.number("offset_learning_s", &height.offset_learning_s, "s", 0.0, 1e6,
           "Time from the first pressure in which the offset between the barometers is learnt; constant "
           "afterwards. 15 averages turbulence and ends before the robot enters another ventilation zone.");
  s.number("weather_rate_m_s", &height.weather_rate_m_s, "m/s", 0.0, 1.0,
           "Rate of the weather as a height rate without a base station, 1 sigma. 0.0021 is 0.025 Pa/s: "
           "fronts move 1 to 4 hPa in three hours.");
  s.number("weather_walk_m_sqrt_s", &height.weather_walk_m_sqrt_s, "m/sqrt(s)", 0.0, 10.0,
           "Random walk of the weather as a height without a base station. 0.018 is 0.2 Pa/sqrt(s): open air "
           "(0.05 to 0.2) and wind on the building.");
}

void add_reported_variance(HeightConfig& height, SectionBuilder& s) {
  s.number("warm_up_sigma_m", &height.warm_up_sigma_m, "m", 0.0, 10.0,
           "Drift of two barometers that warm up, 1 sigma; only added to the reported variance, because no "
           "sensor observes it.");
  s.number("warm_up_time_s", &height.warm_up_time_s, "s", 1.0, 1e5,
           "Time constant of the warm-up drift. 300: a housing warms up in minutes.");
  s.number("zone_sigma_m", &height.zone_sigma_m, "m", 0.0, 10.0,
           "Pressure difference between ventilation zones as a height, 1 sigma; only added to the reported "
           "variance. 0.05: 0.3 to 1 Pa; the paper's runs show 2 to 35 cm.");
}

void add_gates(HeightConfig& height, SectionBuilder& s) {
  s.number("slew_rate_m_s", &height.slew_rate_m_s, "m/s", 1e-3, 10.0,
           "Rate at which the height takes in the weather of an outage when a base station returns. 0.012: "
           "the map tolerates 0.02.");
  s.number("slew_bound_m", &height.slew_bound_m, "m", 0.01, 1e3,
           "Largest height error taken in at slew_rate_m_s when a base station returns; the excess is taken "
           "in at once. 3: beyond it, minutes of a wrong height are worse than a step.");
  s.number("gate_sigma", &height.gate_sigma, "", 2.0, 20.0,
           "Innovation gate of the pressure in standard deviations; a pressure beyond it is not used for up "
           "to gate_time_s. 4: exceeded by chance once in 16000 samples.");
  s.number("gate_time_s", &height.gate_time_s, "s", 0.0, 60.0,
           "Longest time that the gate (gate_sigma) rejects the pressure; then the pressure is right. 3: "
           "doors last 1 to 2 s.");
  s.number(
      "barometer_timeout_s", &height.barometer_timeout_s, "s", 0.2, 60.0,
      "Time without a usable sample, and at least three intervals, after which the barometer is lost and "
      "the height is held. 0.4: told within half a second.");
}

void add_moving_ground(HeightConfig& height, SectionBuilder& s) {
  s.number(
      "moving_ground_speed_m_s", &height.moving_ground_speed_m_s, "m/s", 0.02, 5.0,
      "Moving ground (elevator) begins when the vertical speeds from acceleration and from wheels differ "
      "by more than this and by moving_ground_sigma. 0.12: elevators are much faster.");
  s.number("moving_ground_sigma", &height.moving_ground_sigma, "", 2.0, 20.0,
           "Standard deviations by which the vertical speeds must also differ before the ground moves. 5: "
           "practically never by noise.");
  s.number("ground_stopped_speed_m_s", &height.ground_stopped_speed_m_s, "m/s", 1e-3, 5.0,
           "Moving ground ends when the vertical speeds from acceleration and from wheels agree within this "
           "for ground_stopped_time_s. 0.04: a third of the speed at which it begins.");
  s.number("ground_stopped_time_s", &height.ground_stopped_time_s, "s", 0.1, 10.0,
           "Time that the vertical speeds must agree before moving ground ends. Shorter, noise could end a "
           "ride.");
}

}  // namespace

void add_height_settings(HeightConfig& height, std::vector<Setting>& settings) {
  SectionBuilder s("height", UsedBy::kRobot, settings);
  add_acceleration(height, s);
  add_climb(height, s);
  add_air(height, s);
  add_reported_variance(height, s);
  add_gates(height, s);
  add_moving_ground(height, s);
}

}  // namespace isobar
