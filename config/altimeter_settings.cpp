// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"
#include "core/plausibility.hpp"

namespace isobar {
namespace {

void add_pressure_range(AltimeterConfig& altimeter, SectionBuilder& s) {
  s.number("min_pressure_pa", &altimeter.min_pressure_pa, "Pa", kPlausiblePressurePa.lowest,
           kPlausiblePressurePa.highest,
           "Lowest air pressure at the site; lower samples are refused. 30000 is 9 km above sea level.");
  s.number("max_pressure_pa", &altimeter.max_pressure_pa, "Pa", kPlausiblePressurePa.lowest,
           kPlausiblePressurePa.highest,
           "Highest air pressure at the site; higher samples are refused. 115000 is a mine 1.1 km below sea "
           "level.");
}

void add_noise(AltimeterConfig& altimeter, SectionBuilder& s) {
  s.number("noise_floor_pa", &altimeter.noise_floor_pa, "Pa", 1e-3, 1e3,
           "Lower bound of the white noise of a sample, which is estimated online. 0.1: no chip is better; a "
           "DPS310 reaches 0.2.");
  s.number("noise_ceiling_pa", &altimeter.noise_ceiling_pa, "Pa", 1e-3, 1e3,
           "Upper bound of the white noise of a sample, which is estimated online. 20: more than any working "
           "sensor, and 1.7 m of height.");
  s.number("initial_noise_pa", &altimeter.initial_noise_pa, "Pa", 1e-3, 1e3,
           "White noise of a sample until enough samples have been received to estimate it. 0.5: a DPS310 at "
           "32 Hz has 0.35.");
}

void add_faults(AltimeterConfig& altimeter, SectionBuilder& s) {
  s.number("base_walk_pa_sqrt_s", &altimeter.base_walk_pa_sqrt_s, "Pa/sqrt(s)", 1e-4, 10.0,
           "Random walk of the base station's pressure: sets its low-pass. 0.06 smooths a 32 Hz DPS310 over "
           "about 1 s: its noise shrinks eight times, and the lag behind a storm of 100 Pa an hour is 0.03 "
           "Pa.");
  s.number("base_timeout_s", &altimeter.base_timeout_s, "s", 0.5, 600.0,
           "Silence after which a base station is lost, and age at which its samples are refused. 10: "
           "weather moves 0.1 to 0.3 Pa meanwhile.");
  s.number("spike_pa", &altimeter.spike_pa, "Pa", 1.0, 1e5,
           "Smallest step between two samples that counts as a spike. 200: 17 m, which no motion explains.");
  s.number("spike_confirmations", &altimeter.spike_confirmations, "", 1, 1'000,
           "Samples that must agree on a new level before it is believed. 5: 0.16 s at 32 Hz.");
}

void add_silence(AltimeterConfig& altimeter, SectionBuilder& s) {
  s.number("stuck_timeout_s", &altimeter.stuck_timeout_s, "s", 0.5, 600.0,
           "Time without a change of a single bit, and at least six of the sensor's intervals, after which a "
           "sensor is stuck. Noise alone changes a working sensor's last digit at every conversion.");
  s.used_by(UsedBy::kRobot);
  s.number("silent_timeout_s", &altimeter.silent_timeout_s, "s", 0.05, 60.0,
           "Silence, and at least three of the sensor's intervals, after which a sensor is off. 0.4: told "
           "within half a second.");
}

void add_air(AirTemperatureConfig& air, std::vector<Setting>& settings) {
  SectionBuilder s("altimeter.air", UsedBy::kRobot, settings);
  s.choice("mode", &air.mode, air_temperature_choices(),
           "Source of the air temperature. auto: the barometers' own thermometers. fixed: fixed_c.");
  s.number("fixed_c", &air.fixed_c, "degC", -60.0, 60.0,
           "Air temperature where mode is \"fixed\", and in mode \"auto\" until a thermometer is heard and "
           "to tell "
           "which of two thermometers is wrong. 20: buildings are heated to it; set it outdoors.");
  s.number("expected_self_heating_k", &air.expected_self_heating_k, "K", -10.0, 30.0,
           "Self-heating of the coldest barometer, subtracted from its reading. 0.5: a ventilated chip warms "
           "itself by 0.3 to 1.2.");
  s.number("max_self_heating_k", &air.max_self_heating_k, "K", 0.0, 30.0,
           "Largest self-heating: the estimate never falls further below the coldest barometer. 8: chips "
           "near a processor read 2 to 8 too warm.");
  s.number("fall_time_s", &air.fall_time_s, "s", 1.0, 1e6,
           "Time constant of a falling estimate: a colder sensor proves colder air. 60 keeps the height from "
           "jumping: 5 K at 12 m are 20 cm.");
  s.number("rise_time_s", &air.rise_time_s, "s", 1.0, 1e6,
           "Time constant of a rising estimate. 3600: a rising reading is self-heating rather than weather.");
  s.number("smoothing_time_s", &air.smoothing_time_s, "s", 0.1, 600.0,
           "Time constant of each thermometer's low-pass. 5 takes out its noise before the lowest is taken.");
  s.number("sigma_k", &air.sigma_k, "K", 0.0, 30.0,
           "Uncertainty of the mean air temperature between base station and robot, 1 sigma; enters the "
           "height's variance. 2 is 0.7 % of every height.");
}

}  // namespace

void add_altimeter_settings(AltimeterConfig& altimeter, std::vector<Setting>& settings) {
  SectionBuilder s("altimeter", UsedBy::kRobot, settings);
  add_pressure_range(altimeter, s);
  add_faults(altimeter, s);
  s.used_by(UsedBy::kEveryRole);  // a base station measures its own noise and notices a stuck sensor
  add_noise(altimeter, s);
  add_silence(altimeter, s);
  add_air(altimeter.air, settings);
}

}  // namespace isobar
