// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

namespace isobar {
namespace {

void add_altimeter(AltimeterConfig& altimeter, std::vector<Setting>& settings) {
  const auto add = [&settings](const char* name, Setting::Target target, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("altimeter.") + name, target, unit, lowest, highest, doc});
  };
  add("min_pressure_pa", &altimeter.min_pressure_pa, "Pa", 1.0, 200e3,
      "Lowest plausible pressure. 30 kPa is 9 km up.");
  add("max_pressure_pa", &altimeter.max_pressure_pa, "Pa", 1.0, 200e3,
      "Highest plausible pressure. 115 kPa is a mine 1.1 km down.");
  add("noise_floor_pa", &altimeter.noise_floor_pa, "Pa", 1e-3, 1e3,
      "White noise of a sample is estimated online, but never below this.");
  add("noise_ceiling_pa", &altimeter.noise_ceiling_pa, "Pa", 1e-3, 1e3, "And never above this.");
  add("initial_noise_pa", &altimeter.initial_noise_pa, "Pa", 1e-3, 1e3,
      "White noise until enough samples have come. DPS310 at 32 Hz: 0.35.");
  add("base_walk_pa_sqrt_s", &altimeter.base_walk_pa_sqrt_s, "Pa/sqrt(s)", 1e-4, 10.0,
      "How fast the base station's pressure may wander: sets its low-pass. 0.06 smooths a 32 Hz DPS310 over "
      "about 1 s.");
  add("base_timeout_s", &altimeter.base_timeout_s, "s", 0.5, 600.0,
      "A base station silent for longer is lost. Weather moves 0.1 to 0.3 Pa meanwhile.");
  add("spike_pa", &altimeter.spike_pa, "Pa", 1.0, 1e5,
      "Step between two samples that no motion explains. 200 Pa is 17 m.");
  add("spike_confirmations", &altimeter.spike_confirmations, "", 1, 1'000,
      "So many samples must agree on a new level before it is believed.");
  add("stuck_timeout_s", &altimeter.stuck_timeout_s, "s", 0.5, 600.0,
      "A sensor whose value does not change by one bit for longer, and for six of its own intervals, is "
      "stuck.");
  add("silent_timeout_s", &altimeter.silent_timeout_s, "s", 0.05, 60.0,
      "A sensor that sends nothing for longer, and for three of its own intervals, is off.");
}

void add_air(AirTemperatureConfig& air, std::vector<Setting>& settings) {
  settings.push_back({.key = "altimeter.air.mode",
                      .target = &air.mode,
                      .doc = "auto: from the barometers' own thermometers. fixed: fixed_c.",
                      .choices = air_temperature_choices()});
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("altimeter.air.") + name, &value, unit, lowest, highest, doc});
  };
  add("fixed_c", air.fixed_c, "degC", -60.0, 60.0,
      "Air temperature where mode is fixed, and until a thermometer has spoken. Buildings are heated to "
      "20.");
  add("expected_self_heating_k", air.expected_self_heating_k, "K", -10.0, 30.0,
      "What the coldest barometer is expected to read above the air; taken off.");
  add("max_self_heating_k", air.max_self_heating_k, "K", 0.0, 30.0,
      "Most that a barometer warms itself above the air. Chips near a processor read 2 to 8 K too warm.");
  add("fall_time_s", air.fall_time_s, "s", 1.0, 1e6,
      "Time constant downwards: a colder sensor proves colder air, but the height must not jump.");
  add("rise_time_s", air.rise_time_s, "s", 1.0, 1e6,
      "Time constant upwards: a rising reading is self-heating rather than weather.");
  add("smoothing_time_s", air.smoothing_time_s, "s", 0.1, 600.0, "Low-pass of each thermometer.");
  add("sigma_k", air.sigma_k, "K", 0.0, 30.0, "Uncertainty of the mean air temperature of the column.");
}

void add_attitude(AttitudeConfig& attitude, std::vector<Setting>& settings) {
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("attitude.") + name, &value, unit, lowest, highest, doc});
  };
  add("start_time_s", attitude.start_time_s, "s", 0.1, 10.0,
      "Roll and pitch start from the mean specific force over this time.");
  add("gyro_bias_sigma_rad_s", attitude.gyro_bias_sigma_rad_s, "rad/s", 0.0, 0.5,
      "Turn-on bias of each gyro axis, 1 sigma. 0.5 deg/s is a consumer-to-industrial MEMS.");
  add("gyro_bias_walk_rad_s_sqrt_s", attitude.gyro_bias_walk_rad_s_sqrt_s, "rad/s/sqrt(s)", 0.0, 0.01,
      "Random walk of the gyro bias: 10 deg/h over some minutes.");
  add("gyro_noise_rad_sqrt_s", attitude.gyro_noise_rad_sqrt_s, "rad/sqrt(s)", 1e-6, 0.1,
      "Floor of the angle random walk, raised online. Between a VN-100 and an MTi-10.");
  add("accel_bias_sigma_m_s2", attitude.accel_bias_sigma_m_s2, "m/s^2", 0.0, 1.0,
      "Bias of each accelerometer axis, 1 sigma. 0.03 is 3 mg, 0.18 deg of roll or pitch.");
  add("accel_bias_walk_m_s2_sqrt_s", attitude.accel_bias_walk_m_s2_sqrt_s, "m/s^2/sqrt(s)", 0.0, 0.1,
      "Random walk of that bias.");
  add("accel_noise_m_s_sqrt_s", attitude.accel_noise_m_s_sqrt_s, "m/s/sqrt(s)", 1e-5, 1.0,
      "Floor of the velocity random walk, raised online by vibration.");
  add("wheel_sigma_m_s", attitude.wheel_sigma_m_s, "m/s", 1e-3, 1.0,
      "Fixed error of the wheels' speed, 1 sigma.");
  add("wheel_sigma_share", attitude.wheel_sigma_share, "", 1e-3, 1.0,
      "Error of the wheels' speed as a share of it. Tracks slip by per cents.");
  add("wheel_correlation_s", attitude.wheel_correlation_s, "s", 0.01, 10.0, "How long a slip lasts.");
  add("lateral_sigma_m_s", attitude.lateral_sigma_m_s, "m/s", 1e-3, 1.0,
      "Sideways slip of the robot, 1 sigma.");
  add("vertical_sigma_m_s", attitude.vertical_sigma_m_s, "m/s", 1e-3, 1.0,
      "Motion of the robot across its own floor, 1 sigma.");
  add("free_velocity_sigma_m_s", attitude.free_velocity_sigma_m_s, "m/s", 0.05, 20.0,
      "Without wheels: rms of the velocity. A pendulum on 10 to 30 m of rope swings with 0.3 to 0.5.");
  add("free_velocity_correlation_s", attitude.free_velocity_correlation_s, "s", 0.1, 60.0,
      "Without wheels: how long a velocity lasts.");
  settings.push_back({.key = "attitude.use_imu_attitude",
                      .target = &attitude.use_imu_attitude,
                      .doc = "Use the IMU's own attitude. Off: what a device's filter does in an elevator or "
                             "on stairs is not documented."});
  add("imu_attitude_sigma_rad", attitude.imu_attitude_sigma_rad, "rad", 1e-4, 0.5,
      "Error of the IMU's own roll and pitch, 1 sigma.");
  add("imu_attitude_correlation_s", attitude.imu_attitude_correlation_s, "s", 0.01, 60.0,
      "How long that error lasts.");
}

void add_standstill(StandstillConfig& standstill, std::vector<Setting>& settings) {
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("standstill.") + name, &value, unit, lowest, highest, doc});
  };
  add("window_s", standstill.window_s, "s", 0.1, 5.0, "All must be quiet for this long.");
  add("max_gyro_rms_rad_s", standstill.max_gyro_rms_rad_s, "rad/s", 1e-4, 1.0,
      "Rms of the angular rate about its mean, each axis.");
  add("max_accel_rms_m_s2", standstill.max_accel_rms_m_s2, "m/s^2", 1e-3, 10.0,
      "Rms of the specific force about its mean.");
  add("max_rate_rad_s", standstill.max_rate_rad_s, "rad/s", 1e-4, 1.0,
      "Mean rate, bias taken out: a robot turns faster than this or stands.");
  add("max_wheel_speed_m_s", standstill.max_wheel_speed_m_s, "m/s", 0.0, 1.0,
      "Wheel speed that counts as zero.");
  add("max_wheel_rate_rad_s", standstill.max_wheel_rate_rad_s, "rad/s", 0.0, 1.0,
      "Turn rate of the wheels that counts as zero.");
}

void add_dead_reckoning(DeadReckoningConfig& dead_reckoning, std::vector<Setting>& settings) {
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("dead_reckoning.") + name, &value, unit, lowest, highest, doc});
  };
  add("wheel_timeout_s", dead_reckoning.wheel_timeout_s, "s", 0.05, 10.0,
      "Wheels silent for longer are lost.");
  add("max_speed_m_s", dead_reckoning.max_speed_m_s, "m/s", 0.1, 50.0,
      "Faster is a fault of encoder or link.");
  add("max_turn_rate_rad_s", dead_reckoning.max_turn_rate_rad_s, "rad/s", 0.1, 50.0, "The same for turning.");
  add("max_acceleration_m_s2", dead_reckoning.max_acceleration_m_s2, "m/s^2", 1.0, 1e3,
      "The same between two samples.");
}

void add_height(HeightConfig& height, std::vector<Setting>& settings) {
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("height.") + name, &value, unit, lowest, highest, doc});
  };
  add("accel_bias_sigma_m_s2", height.accel_bias_sigma_m_s2, "m/s^2", 0.0, 1.0,
      "Bias of the vertical acceleration, 1 sigma: accelerometer, local gravity and tilt together.");
  add("accel_bias_walk_m_s2_sqrt_s", height.accel_bias_walk_m_s2_sqrt_s, "m/s^2/sqrt(s)", 0.0, 0.1,
      "Random walk of that bias.");
  add("accel_noise_m_s_sqrt_s", height.accel_noise_m_s_sqrt_s, "m/s/sqrt(s)", 1e-5, 1.0,
      "Floor of the noise of the vertical acceleration, raised online by vibration.");
  add("slope_sigma_rad", height.slope_sigma_rad, "rad", 0.0, 0.2,
      "Angle between the wheels' plane and base_link as the attitude sees it, 1 sigma.");
  add("slope_walk_rad_sqrt_s", height.slope_walk_rad_sqrt_s, "rad/sqrt(s)", 0.0, 0.1,
      "Random walk of that angle.");
  add("slope_error_rad", height.slope_error_rad, "rad", 0.0, 0.2,
      "Error of the slope that comes and goes: suspension, uneven floor.");
  add("slope_error_correlation_s", height.slope_error_correlation_s, "s", 0.1, 60.0, "How long it lasts.");
  add("slip_share", height.slip_share, "", 0.0, 1.0,
      "Error of the climb speed as a share of it: slip on stairs.");
  add("slip_correlation_s", height.slip_correlation_s, "s", 0.1, 60.0, "How long it lasts.");
  add("rest_speed_m_s_sqrt_s", height.rest_speed_m_s_sqrt_s, "m/s/sqrt(Hz)", 1e-6, 1.0,
      "Vertical speed of a standing robot's ground, 1 sigma.");
  add("turbulence_sigma_m", height.turbulence_sigma_m, "m", 0.0, 10.0,
      "Local slow pressure noise (turbulence, ventilation) as a height, rms.");
  add("turbulence_time_s", height.turbulence_time_s, "s", 0.1, 600.0, "How long it lasts.");
  add("offset_learning_s", height.offset_learning_s, "s", 0.0, 1e6,
      "The offset between the barometers is learnt this long from the first pressure, then constant.");
  add("weather_rate_m_s", height.weather_rate_m_s, "m/s", 0.0, 1.0,
      "Rate of the weather where no base station takes it out, 1 sigma: 1 to 4 hPa in three hours.");
  add("weather_walk_m_sqrt_s", height.weather_walk_m_sqrt_s, "m/sqrt(s)", 0.0, 10.0,
      "Random walk of that weather, wind on the building included: 0.2 Pa/sqrt(s).");
  add("warm_up_sigma_m", height.warm_up_sigma_m, "m", 0.0, 10.0,
      "Drift of two barometers that warm up, 1 sigma; only added to the reported variance.");
  add("warm_up_time_s", height.warm_up_time_s, "s", 1.0, 1e5, "Its time constant.");
  add("zone_sigma_m", height.zone_sigma_m, "m", 0.0, 10.0,
      "Pressure between ventilated zones, 1 sigma; only added to the reported variance.");
  add("slew_rate_m_s", height.slew_rate_m_s, "m/s", 1e-3, 10.0,
      "A base station that returns tells the weather since: the height takes it in at this speed …");
  add("slew_bound_m", height.slew_bound_m, "m", 0.01, 1e3, "… and of more than this the rest at once.");
  add("gate_sigma", height.gate_sigma, "", 2.0, 20.0,
      "A pressure farther off than this many sigmas is not used …");
  add("gate_time_s", height.gate_time_s, "s", 0.0, 60.0,
      "… for this long at most. Doors last 1 to 2 s; after that the pressure is right.");
  add("barometer_timeout_s", height.barometer_timeout_s, "s", 0.2, 60.0,
      "A barometer without a usable sample for longer is lost: the height is held.");
  add("moving_ground_speed_m_s", height.moving_ground_speed_m_s, "m/s", 0.02, 5.0,
      "The ground moves (elevator) when acceleration and wheels differ by more than this …");
  add("moving_ground_sigma", height.moving_ground_sigma, "", 2.0, 20.0,
      "… and by this many standard deviations.");
  add("ground_stopped_speed_m_s", height.ground_stopped_speed_m_s, "m/s", 1e-3, 5.0,
      "It has stopped when both agree within this …");
  add("ground_stopped_time_s", height.ground_stopped_time_s, "s", 0.1, 10.0, "… for this long.");
}

void add_limits(PriorLimits& limits, std::vector<Setting>& settings) {
  const auto add = [&settings](const char* name, double& value, const char* unit, double lowest,
                               double highest, const char* doc) {
    settings.push_back({std::string("limits.") + name, &value, unit, lowest, highest, doc});
  };
  add("max_gyro_rad_s", limits.max_gyro_rad_s, "rad/s", 0.1, 100.0,
      "Largest angular rate of an axis. 35 is a gyro's 2000 deg/s.");
  add("max_accel_m_s2", limits.max_accel_m_s2, "m/s^2", 20.0, 1e3,
      "Largest specific force of an axis. 160 is 16 g.");
  add("imu_gap_s", limits.imu_gap_s, "s", 0.005, 10.0,
      "A longer step of IMU time is a gap: bridged, counted, uncertainty added.");
  add("imu_restart_s", limits.imu_restart_s, "s", 0.1, 600.0,
      "A longer step needs a second sample that agrees; after it the attitude starts anew.");
  add("max_ahead_s", limits.max_ahead_s, "s", 0.1, 600.0,
      "Samples of other sensors this far ahead of the IMU are refused.");
}

}  // namespace

void add_prior_settings(PriorConfig& prior, std::vector<Setting>& settings) {
  add_altimeter(prior.altimeter, settings);
  add_air(prior.altimeter.air, settings);
  add_attitude(prior.attitude, settings);
  add_standstill(prior.standstill, settings);
  add_dead_reckoning(prior.dead_reckoning, settings);
  add_height(prior.height, settings);
  add_limits(prior.limits, settings);
}

}  // namespace isobar
