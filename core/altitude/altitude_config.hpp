// SPDX-License-Identifier: BSD-3-Clause
// Settings of the altimeter, each with its unit and the reason for its default. Ranges: settings table in
// config/.
#pragma once

#include <cstdint>

#include "core/name_table.hpp"
#include "core/plausibility.hpp"

namespace isobar {

/// Source of the air temperature in the hypsometric equation.
enum class AirTemperatureMode : std::uint8_t {
  kAuto,   ///< the barometers' own thermometers, see AirTemperatureTracker
  kFixed,  ///< AirTemperatureConfig::fixed_c
};

inline constexpr NameTable<AirTemperatureMode, 2> kAirTemperatureModeNames{{{
    {AirTemperatureMode::kAuto, "auto"},
    {AirTemperatureMode::kFixed, "fixed"},
}}};

/// Air temperature between base station and robot. An error of 10 K is 3.4 % of every height.
struct AirTemperatureConfig {
  AirTemperatureMode mode = AirTemperatureMode::kAuto;

  /// Air temperature [degC]: with kFixed always, with kAuto until the first reading of a thermometer, and to tell
  /// which of two thermometers is wrong. Buildings are heated to 20; outdoors set the actual value.
  double fixed_c = 20.0;

  /// Expected self-heating of the coldest barometer [K], subtracted. The chip of even a ventilated base
  /// station warms itself by 0.3 to 1.2 K, a thermometer in free air not at all, and thermometers are
  /// accurate to 0.5 K. The default lies in between; 0.5 K is 2 cm at 12 m.
  double expected_self_heating_k = 0.5;

  /// Largest self-heating of a barometer [K]: bounds how far the estimate stays below the coldest sensor
  /// after a visit to a colder place. Chips near a processor read 2 to 8 K too warm.
  double max_self_heating_k = 8.0;

  /// Time constants of a falling and a rising estimate [s]. Falling: a sensor colder than the estimate proves
  /// colder air; a minute keeps the height from jumping (5 K at 12 m are 20 cm). Rising: more likely
  /// self-heating than weather, so it takes an hour.
  double fall_time_s = 60.0;
  double rise_time_s = 3600.0;

  /// Time constant of each thermometer's low-pass [s]: removes noise before the minimum is taken.
  double smoothing_time_s = 5.0;

  /// Standard deviation of the column's mean air temperature [K]; enters the height's variance.
  double sigma_k = 2.0;
};

/// Checks of barometers and their conversion to height differences.
struct AltimeterConfig {
  AirTemperatureConfig air;

  /// Air pressures at the site [Pa]. 30 kPa is 9 km up, 115 kPa a mine 1.1 km down.
  double min_pressure_pa = kGroundPressurePa.lowest;
  double max_pressure_pa = kGroundPressurePa.highest;

  /// Bounds and initial value of the white noise of one sample, estimated online [Pa]. The floor is below the
  /// best chip (DPS310: 0.2 Pa); the initial value holds until enough samples have come (DPS310 at 32 Hz:
  /// 0.35 Pa).
  double noise_floor_pa = 0.1;
  double noise_ceiling_pa = 20.0;
  double initial_noise_pa = 0.5;

  /// Random walk of the pressure at the base station [Pa/sqrt(s)]. 0.06 smooths a 32 Hz DPS310 over about 1
  /// s: its noise shrinks eight times, and the lag behind a storm of 100 Pa an hour is 0.03 Pa.
  double base_walk_pa_sqrt_s = 0.06;

  /// Silence after which a base station is lost [s]: its last pressure is held and the height's source
  /// becomes the single barometer. Weather changes the pressure by 0.1 to 0.3 Pa in that time. Samples older
  /// than this on arrival are refused.
  double base_timeout_s = 10.0;

  /// Spike: difference between successive samples of one sensor that no motion explains [Pa]. 200 Pa is 17 m
  /// in one sample. A new level is accepted once `spike_confirmations` samples agree on it.
  double spike_pa = 200.0;
  std::uint32_t spike_confirmations = 5;

  /// Time without any change of the value after which a sensor is stuck and counts as silent (at least six of
  /// its own intervals) [s]. In a working sensor noise changes the last digit at every conversion.
  double stuck_timeout_s = 1.5;

  /// Silence after which a sensor is off (at least three of its own intervals) [s].
  double silent_timeout_s = 0.4;
};

}  // namespace isobar
